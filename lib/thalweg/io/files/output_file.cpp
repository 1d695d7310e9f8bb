// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/output_file.hpp>

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/internal/durable.hpp>
#include <thalweg/io/files/internal/leftovers.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

OutputFile::OutputFile(std::string const& path, Existing existing) : path_(path), existing_(existing) {
    if (!fs::path(path).has_filename()) {
        throw BadParameter(fmt::format("io.output_file: '{}' is not a valid file name", path));
    }
    fs::path const folder = fs::path(path).parent_path();
    std::error_code ignored;
    if (!folder.empty() && !fs::is_directory(folder, ignored)) {
        throw BadInput(fmt::format("io.output_file: there is no folder {} for {}", folder.string(), path));
    }
    require_place();
    sweep_leftovers(folder);
    staging_ = (folder / fmt::format(".{}-{}", temporary_mark(), fs::path(path).filename().string())).string();
    fs::remove(staging_, ignored); // of an earlier process of the same number
}

OutputFile::~OutputFile() {
    std::error_code ignored;
    fs::remove(staging_, ignored);
}

void OutputFile::require_place() const {
    std::error_code ignored;
    auto const status = fs::symlink_status(path_, ignored);
    if (!fs::exists(status)) {
        return;
    }
    if (!fs::is_regular_file(status)) {
        throw BadInput(fmt::format("io.output_file: {} exists and is not a regular file: name another", path_));
    }
    if (existing_ == Existing::refuse) {
        throw BadInput(fmt::format("io.output_file: {} already exists: name another or use --overwrite", path_));
    }
}

void OutputFile::commit() {
    require_place(); // something may have come since
    make_durable(staging_, "io.output_file");
    std::error_code error;
    fs::rename(staging_, path_, error);
    if (error) {
        throw IoError(fmt::format("io.output_file: {}: {}", path_, error.message()));
    }
    make_durable(fs::path(path_).parent_path(), "io.output_file");
}

} // namespace thalweg::io
