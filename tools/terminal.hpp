// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include <thalweg/core/run.hpp>

namespace thalweg::tools {

/// What a person sees on stderr: finished lines, and below them a progress bar with the time left, on a terminal only.
class Terminal {
public:
    enum class Manner { talk, quiet };
    explicit Terminal(Manner manner);
    ~Terminal();
    Terminal(Terminal const&) = delete;
    Terminal& operator=(Terminal const&) = delete;

    void line(std::string_view text);
    /// Run::progress; argument: the Terminal.
    static int progress(double share, char const* what, void* terminal);

private:
    void wipe();
    void bar(double share, char const* what);

    std::mutex mutex_;
    bool talks_;
    bool bar_wanted_;
    bool bar_shown_ = false;
    bool colour_;
    std::string what_;
    std::chrono::steady_clock::time_point begin_;
    std::chrono::steady_clock::time_point last_;
};

/// Text in bold red, where stderr is a terminal and NO_COLOR is unset; else as it is.
std::string alarmed(std::string_view text);

} // namespace thalweg::tools
