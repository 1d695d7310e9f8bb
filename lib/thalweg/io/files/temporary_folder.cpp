// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/temporary_folder.hpp>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/internal/leftovers.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(std::string const& name) {
    char const* const wanted = std::getenv("TMPDIR");
    std::string const set = wanted == nullptr ? "" : wanted;
    std::error_code failed;
    fs::path const above = fs::temp_directory_path(failed);
    if (failed) {
        throw IoError(fmt::format("io.temporary_folder: the folder for temporary files{} does not exist or is not a "
                                  "folder: set TMPDIR to one that does",
                                  set.empty() ? "" : fmt::format(", TMPDIR={},", set)));
    }
    sweep_leftovers(above);
    std::string folder = (above / fmt::format("{}-{}-XXXXXX", name, temporary_mark())).string();
    if (mkdtemp(folder.data()) == nullptr) {
        throw IoError(
            fmt::format("io.temporary_folder: no folder for temporary files can be made in {}: {}; set TMPDIR "
                        "to another folder",
                        above.string(), std::generic_category().message(errno)));
    }
    path_ = folder;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

} // namespace thalweg::io
