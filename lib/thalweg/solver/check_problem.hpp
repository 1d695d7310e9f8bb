// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run.hpp>
#include <thalweg/solver/poisson.hpp>

namespace thalweg::solver {

/// What solve_poisson asks of its input, whatever solves it. Takes: the stage that asks, for messages.
/// Throws: as solve_poisson; Cancelled.
void check_problem(GridProblem const& problem, PoissonParams const& params, char const* stage, Run const& run = {});

} // namespace thalweg::solver
