// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/internal/undisturbed.hpp>

#include <array>
#include <cstdint>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

struct Sqlite {
    bool is_one = false;
    bool is_write_ahead = false;
};

// The header of an SQLite file: its name, and 2 for write-ahead mode where versions to write and read stand.
Sqlite sqlite_in(fs::path const& file) {
    std::array<char, 20> header{};
    std::ifstream stream(file, std::ios::binary);
    bool const is_one =
        stream.read(header.data(), header.size()) && std::string(header.data(), 15) == "SQLite format 3";
    return {is_one, is_one && (header[18] == 2 || header[19] == 2)};
}

struct State {
    std::uintmax_t bytes = 0;
    fs::file_time_type changed = {};
    friend bool operator==(State const&, State const&) = default;
};

State state_of(fs::path const& file) {
    return {fs::file_size(file), fs::last_write_time(file)};
}

fs::path wal_of(fs::path const& file) {
    return file.string() + "-wal";
}

// Whether neither part changed while they were copied.
bool copied(fs::path const& file, fs::path const& copy) {
    std::array const before{state_of(file), state_of(wal_of(file))};
    auto const options = fs::copy_options::overwrite_existing;
    fs::copy_file(file, copy, options);
    fs::copy_file(wal_of(file), wal_of(copy), options);
    return before == std::array{state_of(file), state_of(wal_of(file))};
}

} // namespace

Undisturbed::Undisturbed(fs::path const& file) : path_(file) {
    for (char const* const beside : {"", "-journal", "-wal"}) { // SQLite opens these by itself
        std::string const path = file.string() + beside;
        refuse_pipe(path, "io.Undisturbed: " + path);
    }
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) {
        return;
    }
    Sqlite const base = sqlite_in(file);
    if (auto const changes = fs::file_size(wal_of(file), ignored); !base.is_one || ignored || changes == 0) {
        immutable_ = base.is_write_ahead;
        return;
    }
    try {
        copies_ = std::make_unique<TemporaryFolder>("thalweg");
        path_ = copies_->path() / file.filename();
        constexpr int attempts = 3;
        for (int i = 0; i < attempts; ++i) {
            if (copied(file, path_)) {
                return;
            }
        }
    } catch (fs::filesystem_error const& error) {
        throw IoError(fmt::format("io.Undisturbed: {} has changes in {}, and no copy of both can be made: {}",
                                  file.string(), wal_of(file).filename().string(), error.what()));
    }
    throw IoError(fmt::format("io.Undisturbed: {} is being written by another program; close it there and try again",
                              file.string()));
}

char const* const* Undisturbed::options() const {
    static std::array<char const*, 2> constexpr immutable{"IMMUTABLE=YES", nullptr};
    return immutable_ ? immutable.data() : nullptr;
}

} // namespace thalweg::io
