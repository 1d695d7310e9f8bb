// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace thalweg::io {

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
