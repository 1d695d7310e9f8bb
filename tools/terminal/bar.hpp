// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

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

} // namespace thalweg::tools
