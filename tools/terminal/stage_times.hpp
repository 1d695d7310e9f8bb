// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg::tools {

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
