// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/statistics/expected_slope.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/core/numbers/elementary.hpp>

namespace thalweg::solver {

namespace {

constexpr double longest_fine_cells = 12.0;
constexpr double most_fine_share = 0.5;

/// A share of fine forms with the coarse ones lengthened so that the sum is 1/e at the same distances.
StableCovariance shared(StableCovariance const& plain, double fine_share) {
    StableCovariance mixed = plain;
    double const length = std::sqrt(plain.lx_cells * plain.ly_cells);
    double const exponent = 3.0 - plain.dimension;
    mixed.fine_share = fine_share;
    mixed.fine_cells = std::min(longest_fine_cells, length / 4.0);
    double const fine = fine_share * portable::exp(-portable::pow(length / mixed.fine_cells, 2.0 * exponent));
    double const coarse = (portable::exp(-1.0) - fine) / (1.0 - fine_share);
    double const longer = portable::pow(-portable::log(coarse), -0.5 / exponent);
    mixed.lx_cells *= longer;
    mixed.ly_cells *= longer;
    return mixed;
}

} // namespace

double expected_slope(StableCovariance const& covariance, double std) {
    constexpr int angles = 32;
    constexpr int radii = 64;
    // The central difference of heights two cells apart: half of theirs.
    double const x = 0.5 * std * std * (1.0 - covariance(2.0, 0.0));
    double const y = 0.5 * std * std * (1.0 - covariance(0.0, 2.0));
    double sum = 0.0;
    for (int i = 0; i < angles; ++i) {
        double const angle = 0.5 * portable::pi * (i + 0.5) / angles;
        double const c = portable::cos(angle);
        double const s = portable::sin(angle);
        double const scale = std::sqrt(x * c * c + y * s * s);
        for (int j = 0; j < radii; ++j) {
            double const radius = std::sqrt(-2.0 * portable::log((j + 0.5) / radii));
            sum += portable::atan2(scale * radius, 1.0);
        }
    }
    return sum / (angles * radii);
}

StableCovariance with_slope(StableCovariance covariance, double std, double slope_rad) {
    if (expected_slope(covariance, std) >= slope_rad) {
        return covariance;
    }
    double too_little = 0.0;
    double enough = most_fine_share;
    for (int halving = 0; halving < 30; ++halving) {
        double const share = 0.5 * (too_little + enough);
        (expected_slope(shared(covariance, share), std) < slope_rad ? too_little : enough) = share;
    }
    return shared(covariance, enough);
}

} // namespace thalweg::solver
