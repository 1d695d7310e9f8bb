// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/stage_times.hpp"

#include <algorithm>

namespace thalweg::tools {

void StageTimes::count(double now_s) {
    if (!running_.empty()) {
        seconds_[running_.back()].second += now_s - since_s_;
    }
    since_s_ = now_s;
}

void StageTimes::at(std::string_view stage, bool done, double now_s) {
    count(now_s);
    auto known = std::ranges::find(seconds_, stage, [](auto const& one) { return std::string_view(one.first); });
    auto const place = static_cast<std::size_t>(known - seconds_.begin());
    auto const runs = std::ranges::find(running_, place);
    if (runs != running_.end()) { // whatever began within it has ended without saying so
        running_.erase(done ? runs : runs + 1, running_.end());
        return;
    }
    if (known == seconds_.end()) {
        seconds_.emplace_back(stage, 0.0);
    }
    if (!done) {
        running_.push_back(place);
    }
}

std::vector<std::pair<std::string, double>> StageTimes::until(double now_s) {
    count(now_s);
    return seconds_;
}

} // namespace thalweg::tools
