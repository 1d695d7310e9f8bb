// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/internal/new_file.hpp>

#include <cerrno>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::io {

namespace {

[[noreturn]] void fail(std::string const& who) {
    throw IoError(fmt::format("{}: {}", who, std::error_code(errno, std::generic_category()).message()));
}

} // namespace

NewFile::NewFile(std::string const& path, std::string who)
    : who_(std::move(who)), file_(std::fopen(path.c_str(), "wbx")) {
    if (file_ == nullptr) {
        fail(who_);
    }
}

void NewFile::append(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) {
        fail(who_);
    }
}

void NewFile::close() {
    if (std::fclose(file_.release()) != 0) {
        fail(who_);
    }
}

} // namespace thalweg::io
