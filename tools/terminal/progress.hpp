// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg::tools {

/// Speed and remaining time of a stage, both smoothed over a few seconds: a short pause neither stops nor jumps.
class Pace {
public:
    /// share: [0, 1] done; elapsed_s: since the stage began. Neither decreases.
    void at(double share, double elapsed_s);
    double per_second() const { return rate_; } ///< [share/s]; 0: unknown
    double left_s() const { return left_; }     ///< < 0: unknown

private:
    double share_ = 0.0;
    double elapsed_ = 0.0;
    double rate_ = 0.0;
    double left_ = -1.0;
};

/// The content of a bar.
struct BarState {
    std::string what;        ///< the stage's name
    double share = 0.0;      ///< [0,1]
    double per_second = 0.0; ///< [share/s]; 0: not shown
    double left_s = -1.0;    ///< < 0: not shown
    double amount = 0.0;     ///< the whole stage's work; 0: unknown, the rate is then in %
    std::string unit;        ///< of the amount
};

enum class Colour { none, ansi };

/// Formats a bar as one line of at most columns - 1 characters (without escapes), plain ASCII. If there is little room,
/// the rate is dropped first, then the bar, then the time left.
std::string bar_text(BarState const& state, int columns, Colour colour);

/// Adds up the time of each stage, from progress reports. The time of a nested stage does not count for the outer one.
class StageTimes {
public:
    /// A stage reports at a time [s]: it runs from now on or, with done, has ended. Times do not decrease.
    void at(std::string_view stage, bool done, double now_s);
    /// Seconds by stage up to now, in the order of their beginning.
    std::vector<std::pair<std::string, double>> until(double now_s);

private:
    void count(double now_s);

    std::vector<std::pair<std::string, double>> seconds_;
    std::vector<std::size_t> running_; ///< indices into seconds_, the innermost last
    double since_s_ = 0.0;
};

} // namespace thalweg::tools
