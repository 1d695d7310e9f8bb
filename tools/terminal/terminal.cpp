// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/terminal.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <sys/ioctl.h>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>

#include <thalweg/core/run/messages.hpp>

namespace thalweg::tools {

namespace {

constexpr std::string_view to_the_lines_begin = "\r\033[K";

constexpr std::array<std::string_view, 5> tone_codes{"\033[32m", "\033[33m", "\033[1;31m", "\033[1m", "\033[0m"};

/// A line that keeps its tones if the stream supports them, without any other control characters.
std::string shown_line(std::string_view text, bool colours) {
    std::string out;
    while (colours) {
        std::size_t first = std::string_view::npos;
        std::string_view code;
        for (std::string_view const one : tone_codes) {
            if (std::size_t const at = text.find(one); at < first) {
                first = at;
                code = one;
            }
        }
        if (code.empty()) {
            break;
        }
        out += printable(text.substr(0, first)) + std::string(code);
        text.remove_prefix(first + code.size());
    }
    return out + printable(text);
}

int columns_of_stderr() {
    winsize size{};
    constexpr int usual = 80;
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

} // namespace

Abilities abilities(bool is_terminal, char const* term, char const* no_color) {
    std::string_view const kind = term == nullptr ? "" : term;
    bool const moves = is_terminal && !kind.empty() && kind != "dumb";
    return {moves, moves && (no_color == nullptr || *no_color == '\0')};
}

Abilities abilities(std::FILE* stream) {
    return abilities(isatty(fileno(stream)) == 1, std::getenv("TERM"), std::getenv("NO_COLOR"));
}

std::string toned(Tone tone, std::string_view text, std::FILE* stream) {
    if (!abilities(stream).colours) {
        return std::string(text);
    }
    char const* const code = tone == Tone::good      ? "32"
                             : tone == Tone::careful ? "33"
                             : tone == Tone::bad     ? "1;31"
                                                     : "1";
    return fmt::format("\033[{}m{}\033[0m", code, text);
}

Terminal::Terminal(Manner manner, Progress progress)
    : talks_(manner == Manner::talk), is_json_(progress == Progress::json), abilities_(abilities(stderr)) {}

Terminal::~Terminal() {
    wipe();
}

void Terminal::wipe() {
    std::lock_guard const lock(mutex_);
    hide_bar();
}

void Terminal::hide_bar() {
    if (bar_shown_) {
        write_to_stderr(to_the_lines_begin);
        bar_shown_ = false;
    }
}

void Terminal::line(std::string_view text) {
    std::lock_guard const lock(mutex_);
    if (talks_) {
        hide_bar();
        write_to_stderr(fmt::format("{}\n", shown_line(text, abilities_.colours)));
    }
}

void Terminal::data(std::string_view json) {
    std::lock_guard const lock(mutex_);
    write_to_stderr(fmt::format("{}\n", json)); // escaped by its writer
}

void Terminal::begin_stage(std::string_view what) {
    auto const name_end = std::min(what.find(' '), what.size());
    std::string_view const name = what.substr(0, name_end);
    if (state_.what == name && name_end == what.size()) {
        return;
    }
    state_ = BarState{};
    state_.what = name;
    pace_ = Pace();
    begin_ = std::chrono::steady_clock::now();
    last_ = {};
    if (name_end < what.size()) { // "grow 100000 particles"
        std::string_view const rest = what.substr(name_end + 1);
        long long amount = 0;
        auto const [end, fault] = std::from_chars(rest.data(), rest.data() + rest.size(), amount);
        if (fault == std::errc() && end != rest.data() + rest.size()) {
            state_.amount = static_cast<double>(amount);
            state_.unit = std::string(end + 1, rest.data() + rest.size());
        }
    }
}

std::vector<std::pair<std::string, double>> Terminal::times() {
    std::lock_guard const lock(mutex_);
    return times_.until(seconds());
}

double Terminal::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Terminal::show(double share) {
    auto const now = std::chrono::steady_clock::now();
    std::chrono::duration<double> const gone = now - begin_;
    if (gone < std::chrono::milliseconds(300) || now - last_ < std::chrono::milliseconds(100)) {
        return; // a short stage needs no bar
    }
    last_ = now;
    pace_.at(share, gone.count());
    state_.share = share;
    state_.per_second = pace_.per_second();
    state_.left_s = pace_.left_s();
    write_to_stderr(
        fmt::format("{}{}", to_the_lines_begin,
                    bar_text(state_, columns_of_stderr(), abilities_.colours ? Colour::ansi : Colour::none)));
    bar_shown_ = true;
}

void Terminal::report(double share, std::string_view stage) {
    auto const now = std::chrono::steady_clock::now();
    bool const is_end = share >= 1.0;
    bool const is_same = state_.what == stage && (state_.share >= 1.0) == is_end;
    if (is_same && (is_end || now - last_ < std::chrono::milliseconds(100))) {
        return;
    }
    state_.what = stage;
    state_.share = share;
    last_ = now;
    write_to_stderr(
        fmt::format("{{\"stage\": \"{}\", \"share\": {:.4f}}}\n", printable(stage), std::clamp(share, 0.0, 1.0)));
}

int Terminal::progress(double share, char const* what, void* terminal) {
    auto& self = *static_cast<Terminal*>(terminal);
    std::lock_guard const lock(self.mutex_);
    std::string_view const name = what == nullptr ? "" : what;
    std::string_view const stage = name.substr(0, name.find(' '));
    self.times_.at(stage, share >= 1.0, self.seconds());
    if (self.is_json_) {
        self.report(share, stage);
        return 1;
    }
    if (!self.talks_ || !self.abilities_.moves) {
        return 1;
    }
    self.begin_stage(what == nullptr ? "" : what);
    if (share >= 1.0) {
        self.hide_bar();
    } else {
        self.show(share);
    }
    return 1;
}

void write_to_stderr(std::string_view text) noexcept {
    while (!text.empty()) {
        ssize_t const written = write(STDERR_FILENO, text.data(), text.size());
        if (written < 0 && errno != EINTR) {
            return;
        }
        text.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
    }
}

std::string fault_of_stdout() {
    errno = 0;
    bool const failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    return !failed ? "" : errno == 0 ? "it failed earlier" : std::error_code(errno, std::generic_category()).message();
}

void wipe_last_line() {
    if (abilities(stderr).moves) {
        write_to_stderr(to_the_lines_begin);
    }
}

} // namespace thalweg::tools
