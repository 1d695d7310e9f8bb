// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/poisson.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/solver/grid/internal/coloured_problem.hpp>
#include <thalweg/solver/grid/internal/conjugate_gradients.hpp>
#include <thalweg/solver/opencl/internal/poisson_opencl.hpp>

#include <utility>

#include <fmt/format.h>

namespace thalweg::solver {
namespace {

void demand(PoissonParams const& params) {
    if (!(params.tolerance > 0.0 && params.tolerance < 1.0)) {
        throw BadParameter(fmt::format("solver.solve_poisson: a tolerance of {}; it must be greater than 0 and less "
                                       "than 1",
                                       params.tolerance));
    }
    if (params.most_iterations < 0) {
        throw BadParameter(fmt::format("solver.solve_poisson: {} iterations at most; it cannot be less than 0",
                                       params.most_iterations));
    }
}

} // namespace

GridSolution solve_poisson(GridProblem problem, PoissonParams const& params, Run const& run) {
    demand(params);
    Contents const contents = look_through(problem, "solver.solve_poisson", run);
    if (run.device == Device::opencl) {
        return solve_poisson_opencl(std::move(problem), contents, params, run);
    }
    GridSolution solution;
    if (contents.free > 0) {
        GridRows const& rows = grid_rows(widest_grid_lanes());
        ColouredProblem iterate = coloured(problem, contents, run);
        if (double const zero = residual_norm(iterate, rows, run); zero > 0.0) {
            set_guess(problem, contents, iterate, run);
            auto levels = coarse_levels(problem.kind, run);
            Convergence const reached =
                conjugate_gradients(iterate, levels, zero, {params.tolerance, params.most_iterations}, rows, run);
            solution.iterations = reached.iterations;
            solution.residual = reached.residual / zero;
        }
        collect(iterate, contents, problem, run);
    }
    solution.value = std::move(problem.value);
    return solution;
}

} // namespace thalweg::solver
