// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/internal/goals.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <thalweg/core/numbers/elementary.hpp>

namespace thalweg::fractal {

namespace {

using solver::FieldStatistics;
using solver::Quantity;

double figure(FieldStatistics const& is, Quantity quantity) {
    switch (quantity) {
    case Quantity::mean: return is.mean;
    case Quantity::std: return is.std;
    case Quantity::ln_lx: return is.lx.cells;
    case Quantity::ln_ly: return is.ly.cells;
    case Quantity::slope_rad: return is.slope_rad;
    case Quantity::dimension: break;
    }
    return is.dimension;
}

bool by_logarithm(Quantity quantity) {
    return quantity == Quantity::ln_lx || quantity == Quantity::ln_ly;
}

/// The error of a projection: what its caller reads.
double error_of(Goal const& goal, FieldStatistics const& is, double deviation) {
    double const off = std::fabs(figure(is, goal.quantity) - goal.asked);
    double const error = off / (goal.quantity == Quantity::mean ? deviation : goal.asked);
    return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

} // namespace

/// Steps as long as those by which table 4 of paper 001 is met, whose deviation is 131.6 m: there 100 m, 30 m, 0.3,
/// 0.3, 0.05, 0.1.
std::vector<Goal> goals_of(Targets const& targets, double deviation) {
    std::vector<Goal> goals;
    auto const add = [&](char const* name, Quantity quantity, std::optional<double> const& asked, double longest_step) {
        if (asked) {
            goals.push_back({name, quantity, *asked, longest_step});
        }
    };
    add("mean", Quantity::mean, targets.mean, 0.76 * deviation);
    add("std", Quantity::std, targets.std, 0.23 * deviation);
    add("lx_cells", Quantity::ln_lx, targets.lx_cells, 0.3);
    add("ly_cells", Quantity::ln_ly, targets.ly_cells, 0.3);
    add("slope_rad", Quantity::slope_rad, targets.slope_rad, 0.05);
    add("dimension", Quantity::dimension, targets.dimension, 0.1);
    return goals;
}

double missing(Goal const& goal, FieldStatistics const& is) {
    double const got = figure(is, goal.quantity);
    return by_logarithm(goal.quantity) ? portable::log(goal.asked / got) : goal.asked - got;
}

double largest_error(std::vector<Goal> const& goals, FieldStatistics const& is, double deviation) {
    double largest = 0.0;
    for (Goal const& goal : goals) {
        largest = std::max(largest, error_of(goal, is, deviation));
    }
    return largest;
}

double longest_way(std::vector<Goal> const& goals, FieldStatistics const& is) {
    double longest = 0.0;
    for (Goal const& goal : goals) {
        double const steps = std::fabs(missing(goal, is)) / goal.longest_step;
        longest = std::isfinite(steps) ? std::max(longest, steps) : std::numeric_limits<double>::infinity();
    }
    return longest;
}

std::vector<Residual> residuals_of(std::vector<Goal> const& goals, FieldStatistics const& is, double deviation) {
    std::vector<Residual> residuals;
    for (Goal const& goal : goals) {
        residuals.push_back({goal.name, goal.asked, figure(is, goal.quantity), error_of(goal, is, deviation)});
    }
    return residuals;
}

} // namespace thalweg::fractal
