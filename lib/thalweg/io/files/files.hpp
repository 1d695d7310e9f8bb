// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg::io {

/// What to do where an output folder holds something.
enum class Existing {
    refuse,  ///< stop
    replace, ///< old files go, new ones come
    add      ///< new files come beside what is there; of old ones only those of the same name go
};

/// An output folder that appears whole or not at all: files are written into staging() and moved by commit(); without
/// it nothing is left, and what killed processes left in the same place goes. Only files that thalweg wrote before are
/// ever replaced or removed. Takes: folder, which need not exist; old_files: every file an earlier run left in it,
/// report.json included, by its name relative to it ("inputs/rivers.gpkg"); an empty list when it holds no report.
/// \throws BadParameter when folder is ""
/// \throws BadInput when it is not a folder, holds something and existing is refuse, holds something and old_files is
/// empty under replace, or when an old name is absolute, climbs out with "..", is not a plain file, or passes through a
/// link
/// \throws IoError with the path and the system's reason
class OutputFolder {
public:
    explicit OutputFolder(std::string const& folder, Existing existing = Existing::refuse,
                          std::vector<std::string> old_files = {});
    /// Removes what was not committed.
    ~OutputFolder();
    OutputFolder(OutputFolder const&) = delete;
    OutputFolder& operator=(OutputFolder const&) = delete;

    /// \return where to write: beside a new folder (FOLDER.thalweg-tmp-HOST-PID), or in an existing one
    /// (.thalweg-tmp-HOST-PID).
    std::string const& staging() const { return staging_; }
    /// \param name relative name, "dem.tif"
    /// \return the path of a file to be written, "dem.tif" or "inputs/rivers.gpkg"; makes the folders it is in.
    std::string path(std::string const& name) const;

    /// \return every file written so far, relative names, sorted.
    std::vector<std::string> files() const;

    /// Puts the files in place, the old ones removed, when all of them are on the disk. When it fails everything is as
    /// it was before.
    /// \throws BadInput when a file would replace one that is not among old_files
    void commit();

private:
    std::string folder_;
    std::string staging_;
    std::vector<std::string> old_files_;
    std::vector<std::string> made_; // folders above folder_ that were missing, outermost first
    bool adds_ = false;
    bool existed_ = false;
    bool committed_ = false;
};

/// \param path path of the file
/// \return whether a path is a pipe, a socket or a terminal, of which opening or reading may wait for ever.
bool is_pipe_or_device(std::string const& path);

/// \param path path of the file
/// \param what what it is, for messages
/// \throws BadInput where is_pipe_or_device
void refuse_pipe(std::string const& path, std::string const& what);

/// \param path path of the file
/// \param max_bytes most bytes to read
/// \return the bytes of a file.
/// \throws BadInput when there is none, it is a folder, a pipe or larger than max_bytes
std::string read_text(std::string const& path, std::int64_t max_bytes);

/// Writes a new file.
/// \param path path of the file
/// \param text the text
/// \throws IoError with the path and the system's reason, also when the file exists
void write_text(std::string const& path, std::string_view text);

/// Copies a file's bytes into a new file.
/// \param from the file to copy
/// \param to path of the copy
/// \throws BadInput when there is no such file
/// \throws IoError like write_text
void copy_file(std::string const& from, std::string const& to);

/// An output file that appears whole or not at all: it is written at staging() and moved by commit(); without it
/// nothing is left.
/// \throws BadParameter when path is ""
/// \throws BadInput when it exists and existing is refuse, is not a plain file, or its folder does not exist
/// \throws IoError with the system's reason
class OutputFile {
public:
    explicit OutputFile(std::string const& path, Existing existing = Existing::refuse);
    /// Removes what was not committed.
    ~OutputFile();
    OutputFile(OutputFile const&) = delete;
    OutputFile& operator=(OutputFile const&) = delete;

    /// \return where to write: a new file in the same folder, with the same ending.
    std::string const& staging() const { return staging_; }
    /// Puts the file in place when it is on the disk.
    void commit();

private:
    void require_place() const;

    std::string path_;
    std::string staging_;
    Existing existing_;
};

/// A new folder in the system's temporary one (TMPDIR, else the usual place), removed with its content at the end;
/// those of processes that were killed go, too.
class TemporaryFolder {
public:
    /// \param name the beginning of its name
    /// \throws IoError with the reason, naming TMPDIR where that is to blame
    explicit TemporaryFolder(std::string const& name);
    ~TemporaryFolder();
    TemporaryFolder(TemporaryFolder const&) = delete;
    TemporaryFolder& operator=(TemporaryFolder const&) = delete;

    std::filesystem::path const& path() const { return path_; }

private:
    std::filesystem::path path_;
};

} // namespace thalweg::io
