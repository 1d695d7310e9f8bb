// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/internal/durable.hpp>

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(std::string const& who, fs::path const& place, std::error_code reason) {
    throw IoError(fmt::format("{}: {}: {}", who, place.string(), reason.message()));
}

} // namespace

void make_durable(fs::path const& place, std::string const& who) {
    int const file = open(place.empty() ? "." : place.c_str(), O_RDONLY | O_CLOEXEC);
    bool const done = file >= 0 && fsync(file) == 0;
    int const reason = errno;
    if (file >= 0) {
        close(file);
    }
    // Some file systems have no such call, some folders may be written to and not read.
    bool const has_none = reason == EINVAL || reason == ENOTSUP || reason == EROFS;
    std::error_code ignored;
    if (!done && !has_none && !(reason == EACCES && fs::is_directory(place, ignored))) {
        refuse(who, place, {reason, std::generic_category()});
    }
}

void make_all_durable(fs::path const& folder, std::string const& who) {
    std::error_code error;
    fs::recursive_directory_iterator entry(folder, error);
    while (!error && entry != fs::recursive_directory_iterator()) {
        make_durable(entry->path(), who);
        entry.increment(error);
    }
    if (error) {
        refuse(who, folder, error);
    }
    make_durable(folder, who);
}

} // namespace thalweg::io
