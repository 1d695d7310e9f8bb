// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <boost/math/special_functions/gamma.hpp>

/// Chi-squared tests.
namespace chi_squared {

/// Probability that a chi-squared variable with this many degrees of freedom exceeds x.
inline double upper_tail(double x, double freedom) {
    return boost::math::gamma_q(0.5 * freedom, 0.5 * x);
}

struct Result {
    double x = 0.0;
    double freedom = 0.0;
    double p = 1.0;
};

/// Do two samples come from one distribution? Bins with fewer than 40 in both together are merged.
template <class Bin> Result two_samples(std::vector<Bin> const& first, std::vector<Bin> const& second) {
    std::map<Bin, std::pair<double, double>> bins;
    for (Bin const& b : first) {
        bins[b].first += 1.0;
    }
    for (Bin const& b : second) {
        bins[b].second += 1.0;
    }
    std::vector<std::pair<double, double>> kept;
    std::pair<double, double> rare = {0.0, 0.0};
    for (auto const& [bin, n] : bins) {
        if (n.first + n.second < 40.0) {
            rare.first += n.first;
            rare.second += n.second;
        } else {
            kept.push_back(n);
        }
    }
    if (rare.first + rare.second >= 40.0) {
        kept.push_back(rare);
    }
    double const ratio = std::sqrt(static_cast<double>(second.size()) / static_cast<double>(first.size()));
    Result result;
    result.freedom = static_cast<double>(kept.size()) - 1.0;
    for (auto const& [a, b] : kept) {
        double const gap = a * ratio - b / ratio;
        result.x += gap * gap / (a + b);
    }
    result.p = upper_tail(result.x, result.freedom);
    return result;
}

/// Does a sample follow the given probabilities, all of them expected 20 times or more?
inline Result against(std::vector<std::int64_t> const& seen, std::vector<double> const& probability) {
    double total = 0.0;
    for (std::int64_t const n : seen) {
        total += static_cast<double>(n);
    }
    Result result;
    result.freedom = static_cast<double>(seen.size()) - 1.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        double const expected = total * probability[i];
        double const gap = static_cast<double>(seen[i]) - expected;
        result.x += gap * gap / expected;
    }
    result.p = upper_tail(result.x, result.freedom);
    return result;
}

} // namespace chi_squared
