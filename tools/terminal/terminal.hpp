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

/// What may be written to a stream besides plain lines.
struct Abilities {
    bool moves = false; ///< the cursor: a line may be written over
    bool colours = false;
};

/// A terminal moves unless TERM is "dumb" or unset, and colours unless NO_COLOR says anything; nothing else does.
Abilities abilities(bool is_terminal, char const* term, char const* no_color);

/// Of stdout or stderr as they are now.
Abilities abilities(std::FILE* stream);

enum class Tone { good, careful, bad, name };

/// Text in the tone's colour (green, yellow, red, bold) where the stream takes colours; else as it is.
std::string toned(Tone tone, std::string_view text, std::FILE* stream);

/// Writes to stderr; what cannot be written is dropped, for no work is worth less because nobody can be told of it.
/// Takes no lock and no memory.
void write_to_stderr(std::string_view text) noexcept;

/// What a person sees on stderr: finished lines, and below them a bar with rate and time left, on a terminal only. A
/// stage that is over within 0.3 s shows none.
class Terminal {
public:
    enum class Manner { talk, quiet };
    explicit Terminal(Manner manner);
    ~Terminal();
    Terminal(Terminal const&) = delete;
    Terminal& operator=(Terminal const&) = delete;

    void line(std::string_view text);
    /// Takes the bar away; another report brings it back.
    void wipe();
    /// Seconds by stage so far, as StageTimes.
    std::vector<std::pair<std::string, double>> times();
    /// Run::progress; argument: the Terminal.
    static int progress(double share, char const* what, void* terminal);

private:
    void take_bar_away();
    void begin_stage(std::string_view what);
    double seconds() const; ///< since the beginning
    void show(double share);

    std::mutex mutex_;
    bool talks_;
    Abilities abilities_;
    bool bar_shown_ = false;
    BarState state_;
    Pace pace_;
    StageTimes times_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point begin_;
    std::chrono::steady_clock::time_point last_;
};

/// Writes what stdout still holds; why something written to it did not arrive, or "".
std::string fault_of_stdout();

/// Takes whatever stands on stderr's last line away, where that is a terminal: for an end without unwinding.
void wipe_last_line();

} // namespace thalweg::tools
