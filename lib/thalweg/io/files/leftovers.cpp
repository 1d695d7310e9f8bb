// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/internal/leftovers.hpp>

#include <array>
#include <cerrno>
#include <charconv>
#include <exception>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <signal.h> // NOLINT(modernize-deprecated-headers): kill is of POSIX
#include <unistd.h>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

// A process's number says nothing on another host that sees the same folder.
std::string mark_of_host() {
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    return fmt::format("thalweg-tmp-{}-", name.data());
}

bool is_of_the_dead(std::string const& name, std::string const& mark) {
    std::size_t const at = name.find(mark);
    if (at == std::string::npos) {
        return false;
    }
    pid_t process = 0;
    char const* const begin = name.data() + at + mark.size();
    auto const [end, fault] = std::from_chars(begin, name.data() + name.size(), process);
    bool const ends = fault == std::errc() && (end == name.data() + name.size() || *end == '-');
    return ends && process > 0 && kill(process, 0) == -1 && errno == ESRCH;
}

bool holds_old_files(fs::path const& place) {
    std::error_code ignored;
    return place.string().ends_with("-old") || fs::exists(place.string() + "-old", ignored);
}

} // namespace

std::string temporary_mark() {
    return fmt::format("{}{}", mark_of_host(), getpid());
}

void sweep_leftovers(fs::path const& folder) noexcept {
    try {
        std::string const mark = mark_of_host();
        std::vector<fs::path> dead;
        for (fs::directory_entry const& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder)) {
            if (is_of_the_dead(entry.path().filename().string(), mark) && !holds_old_files(entry.path())) {
                dead.push_back(entry.path());
            }
        }
        for (fs::path const& place : dead) {
            std::error_code ignored;
            fs::remove_all(place, ignored);
        }
    } catch (std::exception const&) { // a folder that cannot be read, or no memory: the next run sweeps
    }
}

} // namespace thalweg::io
