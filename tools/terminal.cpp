// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace thalweg::tools {

namespace {

bool stderr_is_terminal() {
    return isatty(STDERR_FILENO) == 1;
}

bool colour_wanted() {
    char const* const no = std::getenv("NO_COLOR");
    return stderr_is_terminal() && (no == nullptr || *no == '\0');
}

} // namespace

Terminal::Terminal(Manner manner)
    : talks_(manner == Manner::talk), bar_wanted_(talks_ && stderr_is_terminal()), colour_(colour_wanted()) {}

Terminal::~Terminal() {
    wipe();
}

void Terminal::wipe() {
    if (bar_shown_) {
        std::fputs("\r\033[K", stderr);
        bar_shown_ = false;
    }
}

void Terminal::line(std::string_view text) {
    std::lock_guard const lock(mutex_);
    if (talks_) {
        wipe();
        fmt::print(stderr, "{}\n", text);
    }
}

void Terminal::bar(double share, char const* what) {
    auto const now = std::chrono::steady_clock::now();
    if (what_ != what) {
        what_ = what;
        begin_ = now;
        last_ = {};
    }
    if (now - begin_ < std::chrono::milliseconds(300) || now - last_ < std::chrono::milliseconds(100)) {
        return; // what is over at once needs no bar
    }
    last_ = now;
    share = std::clamp(share, 0.0, 1.0);
    std::chrono::duration<double> const gone = now - begin_;
    constexpr int width = 30;
    int const full = static_cast<int>(share * width);
    std::string const left = share > 0.02 ? fmt::format("{:.0f} s left", gone.count() * (1.0 - share) / share) : "";
    fmt::print(stderr, "\r\033[K{:<7}{}{:#>{}}{:.>{}}{} {:3.0f} %  {}", what, colour_ ? "\033[34m" : "", "", full, "",
               width - full, colour_ ? "\033[0m" : "", share * 100.0, left);
    std::fflush(stderr);
    bar_shown_ = true;
}

int Terminal::progress(double share, char const* what, void* terminal) {
    auto& self = *static_cast<Terminal*>(terminal);
    std::lock_guard const lock(self.mutex_);
    if (self.bar_wanted_) {
        self.bar(share, what == nullptr ? "" : what);
    }
    return 1;
}

std::string alarmed(std::string_view text) {
    return colour_wanted() ? fmt::format("\033[1;31m{}\033[0m", text) : std::string(text);
}

} // namespace thalweg::tools
