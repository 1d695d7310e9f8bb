// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>

namespace thalweg::fractal {

/// One statistic on its way to its target.
struct Goal {
    char const* name;
    solver::Quantity quantity;
    double asked;
    double longest_step; ///< in the units in which it is derived
};

/// The statistics that have a target. deviation: [m] of the heights, by which steps of mean and deviation are measured.
std::vector<Goal> goals_of(Targets const& targets, double deviation);

/// What is still missing, in the units in which the statistic is derived; not finite where the heights do not tell it.
double missing(Goal const& goal, solver::FieldStatistics const& is);

/// The greatest of the goals' errors, as their residuals tell them; infinite where the heights do not tell one.
double largest_error(std::vector<Goal> const& goals, solver::FieldStatistics const& is, double deviation);

/// How many of its longest steps the goal that is farthest away takes; infinite where the heights do not tell one.
double longest_way(std::vector<Goal> const& goals, solver::FieldStatistics const& is);

/// Of every goal what was asked for, what was got and the error.
std::vector<Residual> residuals_of(std::vector<Goal> const& goals, solver::FieldStatistics const& is, double deviation);

} // namespace thalweg::fractal
