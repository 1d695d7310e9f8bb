// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/ranks.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace thalweg {

double quantile(std::vector<double> values, double share) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    if (values.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    std::sort(values.begin(), values.end());
    double const at = std::clamp(share, 0.0, 1.0) * static_cast<double>(values.size() - 1);
    auto const below = static_cast<std::size_t>(at);
    std::size_t const above = std::min(below + 1, values.size() - 1);
    double const part = at - static_cast<double>(below);
    return part > 0.0 ? values[below] * (1.0 - part) + values[above] * part : values[below];
}

namespace {

/// The ranks of values, from 1; equal values have their mean rank.
std::vector<double> ranks_of(std::vector<double> const& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> ranks(values.size());
    for (std::size_t first = 0; first < order.size();) {
        std::size_t end = first;
        while (end < order.size() && values[order[end]] == values[order[first]]) {
            ++end;
        }
        double const rank = 0.5 * static_cast<double>(first + 1 + end);
        for (; first < end; ++first) {
            ranks[order[first]] = rank;
        }
    }
    return ranks;
}

} // namespace

double rank_correlation(std::vector<double> const& x, std::vector<double> const& y) {
    std::vector<double> known_x;
    std::vector<double> known_y;
    for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
        if (!std::isnan(x[i]) && !std::isnan(y[i])) {
            known_x.push_back(x[i]);
            known_y.push_back(y[i]);
        }
    }
    std::vector<double> const a = ranks_of(known_x);
    std::vector<double> const b = ranks_of(known_y);
    double const mean = 0.5 * static_cast<double>(a.size() + 1);
    double ab = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - mean) * (b[i] - mean);
        aa += (a[i] - mean) * (a[i] - mean);
        bb += (b[i] - mean) * (b[i] - mean);
    }
    if (a.size() < 3 || aa == 0.0 || bb == 0.0) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    return std::clamp(ab / (std::sqrt(aa) * std::sqrt(bb)), -1.0, 1.0);
}

} // namespace thalweg
