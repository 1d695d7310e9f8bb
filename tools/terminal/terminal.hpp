// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "terminal/progress.hpp"

namespace thalweg::tools {

/// What a stream supports besides plain lines.
struct Abilities {
    bool moves = false; ///< the cursor: a line can be overwritten
    bool colours = false;
};

/// A terminal moves unless TERM is "dumb" or unset, and has colours unless NO_COLOR is set; other streams have neither.
Abilities abilities(bool is_terminal, char const* term, char const* no_color);

/// Of stdout or stderr as they are now.
Abilities abilities(std::FILE* stream);

enum class Tone { good, careful, bad, name };

/// Text in the tone's colour (green, yellow, red, bold) if the stream has colours; else unchanged.
std::string toned(Tone tone, std::string_view text, std::FILE* stream);

/// Writes to stderr; failures are ignored, because the work matters more than its messages. Takes no lock and no
/// memory.
void write_to_stderr(std::string_view text) noexcept;

/// Output to stderr: finished lines, and on a terminal a bar with rate and time left below them. Stages shorter than
/// 0.3 s show no bar. For other programs the progress is a line of JSON instead: at the beginning and end of each
/// stage, and between them at most ten a second.
class Terminal {
public:
    enum class Manner { talk, quiet };
    enum class Progress { bar, json };
    explicit Terminal(Manner manner, Progress progress = Progress::bar);
    ~Terminal();
    Terminal(Terminal const&) = delete;
    Terminal& operator=(Terminal const&) = delete;

    void line(std::string_view text);
    /// Writes a line for other programs, where the progress is lines of JSON.
    void data(std::string_view json);
    /// Removes the bar; the next report shows it again.
    void wipe();
    /// Seconds by stage so far, as StageTimes.
    std::vector<std::pair<std::string, double>> times();
    /// Run::progress; argument: the Terminal.
    static int progress(double share, char const* what, void* terminal);

private:
    void hide_bar();
    void begin_stage(std::string_view what);
    double seconds() const; ///< since construction
    void show(double share);
    void report(double share, std::string_view stage);

    std::mutex mutex_;
    bool talks_;
    bool is_json_;
    Abilities abilities_;
    bool bar_shown_ = false;
    BarState state_;
    Pace pace_;
    StageTimes times_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point begin_;
    std::chrono::steady_clock::time_point last_;
};

/// Flushes stdout; returns why output was lost, or "".
std::string fault_of_stdout();

/// Clears stderr's last line on a terminal: for an end without unwinding.
void wipe_last_line();

} // namespace thalweg::tools
