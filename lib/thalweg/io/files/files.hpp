// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg::io {

/// What to do if an output folder is not empty.
enum class Existing {
    refuse,  ///< fail
    replace, ///< old files are replaced by the new ones
    add      ///< existing files stay; only old files with the name of a new one are replaced
};

/// An output folder that is created completely or not at all: files are written into staging() and moved by commit();
/// without it nothing remains, and remains of killed processes in the same place are removed. Only files that thalweg
/// wrote before are replaced or removed. folder: need not exist; old_files: every file that an earlier run left in it,
/// report.json included, by its name relative to it ("inputs/rivers.gpkg"); empty if it has no report.
/// \throws BadParameter when folder is ""
/// \throws BadInput when it is not a folder, has content and existing is refuse, has content and old_files is empty
/// under replace, or when an old name is absolute, contains "..", is not a plain file, or passes through a link
/// \throws IoError with the path and the system's reason
class OutputFolder {
public:
    explicit OutputFolder(std::string const& folder, Existing existing = Existing::refuse,
                          std::vector<std::string> old_files = {});
    /// Removes files that were not committed.
    ~OutputFolder();
    OutputFolder(OutputFolder const&) = delete;
    OutputFolder& operator=(OutputFolder const&) = delete;

    /// \return where to write: beside a new folder (FOLDER.thalweg-tmp-HOST-PID), or in an existing one
    /// (.thalweg-tmp-HOST-PID)
    std::string const& staging() const { return staging_; }
    /// Makes the path for a file, and its folders.
    /// \param name relative name, "dem.tif" or "inputs/rivers.gpkg"
    /// \return where to write it
    std::string path(std::string const& name) const;

    /// \return every file written so far, relative names, sorted
    std::vector<std::string> files() const;

    /// Flushes the files to disk, moves them into place and removes the old ones. If it fails, everything is as before.
    /// \throws BadInput when a file would replace one that is not among old_files
    void commit();

private:
    std::string folder_;
    std::string staging_;
    std::vector<std::string> old_files_;
    std::vector<std::string> made_; // folders above folder_ that were created, outermost first
    bool adds_ = false;
    bool existed_ = false;
    bool committed_ = false;
};

/// \internal
/// Tells which files a folder has already.
/// \param folder any, also one that does not exist
/// \param names of files, relative to it
/// \param existing whether they may be there
/// \return those that are there, in order
/// \throws BadInput when there is one and existing is refuse
std::vector<std::string> files_there(std::string const& folder, std::vector<std::string> const& names,
                                     Existing existing);

/// \internal
/// Tells whether a path is a pipe, a socket or a terminal, where opening or reading may block forever.
/// \param path any
/// \return false: a file, a folder or nothing
bool is_pipe_or_device(std::string const& path);

/// \internal
/// Reads a file.
/// \param path of the file
/// \param max_bytes limit of its size
/// \return its bytes
/// \throws BadInput when it does not exist, or is a folder, a pipe or larger than max_bytes
std::string read_text(std::string const& path, std::int64_t max_bytes);

/// \internal
/// Writes a new file.
/// \param path of the file
/// \param text its bytes
/// \throws IoError with the path and the system's reason, also when the file exists
void write_text(std::string const& path, std::string_view text);

/// \internal
/// Copies a file's bytes into a new file.
/// \param from path of the file
/// \param to path of the copy
/// \throws BadInput when there is no such file
/// \throws IoError as write_text
void copy_file(std::string const& from, std::string const& to);

/// An output file that is created completely or not at all: it is written at staging() and moved by commit(); without
/// it nothing remains.
/// \throws BadParameter when path is ""
/// \throws BadInput when it exists and existing is refuse, is not a plain file, or its folder does not exist
/// \throws IoError with the system's reason
class OutputFile {
public:
    explicit OutputFile(std::string const& path, Existing existing = Existing::refuse);
    /// Removes a file that was not committed.
    ~OutputFile();
    OutputFile(OutputFile const&) = delete;
    OutputFile& operator=(OutputFile const&) = delete;

    /// \return where to write: a new file in the same folder, with the same extension
    std::string const& staging() const { return staging_; }
    /// Flushes the file to disk and moves it into place.
    void commit();

private:
    void require_place() const;

    std::string path_;
    std::string staging_;
    Existing existing_;
};

/// A new folder in the system's temporary one (TMPDIR, else the default), removed with its content by the destructor;
/// folders of killed processes are removed too.
class TemporaryFolder {
public:
    /// Creates the folder.
    /// \param name the beginning of its name
    /// \throws IoError with the reason, naming TMPDIR if that is the cause
    explicit TemporaryFolder(std::string const& name);
    ~TemporaryFolder();
    TemporaryFolder(TemporaryFolder const&) = delete;
    TemporaryFolder& operator=(TemporaryFolder const&) = delete;

    std::filesystem::path const& path() const { return path_; }

private:
    std::filesystem::path path_;
};

} // namespace thalweg::io
