// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/fractal/match_statistics.hpp>

namespace thalweg::fractal {

/// Compresses heights near the extremes so that none reaches them: the identity between two knees, with an exponential
/// tail beyond, continuously differentiable. Clipping would create plains.
class Limiter {
public:
    Limiter(Targets const& targets, double gap_m) {
        double const infinity = std::numeric_limits<double>::infinity();
        double const max = targets.max ? targets.max->z : infinity;
        double const min = targets.min ? targets.min->z : -infinity;
        double const gap = std::min(gap_m, (max - min) / 1000.0);
        low_ = min + gap;
        high_ = max - gap;
        double const mean = targets.mean.value_or((max + min) / 2.0);
        double const room = std::min(max - mean, mean - min);
        knee_ = room < infinity ? knee_share * room : targets.std.value_or(1.0);
    }
    bool bends(double w) const { return w < low_ + knee_ || w > high_ - knee_; }
    double height(double w) const {
        if (w < low_ + knee_) {
            return low_ + knee_ * portable::exp((w - low_ - knee_) / knee_);
        }
        return w > high_ - knee_ ? high_ - knee_ * portable::exp((high_ - knee_ - w) / knee_) : w;
    }
    double slope(double w) const {
        if (w < low_ + knee_) {
            return portable::exp((w - low_ - knee_) / knee_);
        }
        return w > high_ - knee_ ? portable::exp((high_ - knee_ - w) / knee_) : 1.0;
    }

private:
    static constexpr double knee_share = 0.1;
    double low_;
    double high_;
    double knee_;
};

} // namespace thalweg::fractal
