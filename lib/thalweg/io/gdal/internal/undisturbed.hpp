// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <thalweg/io/files/temporary_folder.hpp>

namespace thalweg::io {

/// How a file is opened so that reading changes neither it nor its folder. SQLite writes to a GeoPackage in write-ahead
/// mode even when it is opened to be read: it makes NAME-wal and NAME-shm, and on closing moves what stands in NAME-wal
/// into the file; a NAME-wal beside one in another mode it deletes. One without changes in NAME-wal is therefore opened
/// as immutable; of one with changes a copy is read, which goes with this object. Any other file is opened as it is.
/// Private to this module.
class Undisturbed {
public:
    /// Throws: BadInput like refuse_pipe; IoError when a copy is needed and cannot be made, or the file is being
    /// written meanwhile.
    explicit Undisturbed(std::filesystem::path const& file);
    /// What to open.
    std::string path() const { return path_.string(); }
    /// GDAL's open options, null-terminated.
    char const* const* options() const;

private:
    std::filesystem::path path_;
    std::unique_ptr<TemporaryFolder> copies_; // the folder of the copy; null when there is none
    bool immutable_ = false;
};

} // namespace thalweg::io
