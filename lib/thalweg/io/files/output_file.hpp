// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/io/files/files.hpp>

namespace thalweg::io {

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

} // namespace thalweg::io
