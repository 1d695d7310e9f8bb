// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg::tools {

/// How fast a stage goes and how long it will still take, both smoothed over a few seconds: a stage that halts for a
/// moment neither stops nor jumps.
class Pace {
public:
    /// share: done of the stage [0,1]; elapsed_s: since its begin. Neither goes back.
    void at(double share, double elapsed_s);
    double per_second() const { return rate_; } ///< share a second; 0 while unknown
    double left_s() const { return left_; }     ///< < 0 while unknown

private:
    double share_ = 0.0;
    double elapsed_ = 0.0;
    double rate_ = 0.0;
    double left_ = -1.0;
};

/// What a bar shows of a stage.
struct BarState {
    std::string what;        ///< the stage's name
    double share = 0.0;      ///< [0,1]
    double per_second = 0.0; ///< share a second; 0: not shown
    double left_s = -1.0;    ///< < 0: not shown
    double amount = 0.0;     ///< what the whole stage has to do; 0: unknown, the rate is then in %
    std::string unit;        ///< of the amount
};

enum class Colour { none, ansi };

/// The line of a bar: one line of at most columns - 1 characters (escapes not counted), plain ASCII. Where there is
/// little room the rate goes first, then the bar, then the time left.
std::string bar_text(BarState const& state, int columns, Colour colour);

/// Adds up how long each stage ran, from reports of progress. A stage that runs within another takes its time from it.
class StageTimes {
public:
    /// A stage reports at a time [s]: it runs from now on or, with done, has ended. Times do not go back.
    void at(std::string_view stage, bool done, double now_s);
    /// Seconds by stage up to now, in the order in which they began.
    std::vector<std::pair<std::string, double>> until(double now_s);

private:
    void count(double now_s);

    std::vector<std::pair<std::string, double>> seconds_;
    std::vector<std::size_t> running_; ///< places in seconds_, the innermost last
    double since_s_ = 0.0;
};

} // namespace thalweg::tools
