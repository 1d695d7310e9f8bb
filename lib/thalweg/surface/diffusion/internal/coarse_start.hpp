// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::surface {

/// Gives free cells of a problem the steady state on cells eight times as large, whose height is the mean of the fixed
/// ones in them. Takes: a problem each part of which has a fixed cell.
void start_coarse(solver::GridProblem& problem, Run const& run);

} // namespace thalweg::surface
