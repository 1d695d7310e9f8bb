// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/poisson.hpp>

#include <thalweg/core/run/range.hpp>
#include <thalweg/solver/grid/internal/coloured_problem.hpp>
#include <thalweg/solver/grid/internal/conjugate_gradients.hpp>
#include <thalweg/solver/opencl/internal/poisson_opencl.hpp>

#include <utility>

namespace thalweg::solver {
namespace {

void demand(PoissonParams const& params) {
    require_in("solver.solve_poisson", "tolerance", params.tolerance, Range::inside(0.0, 1.0));
    require_in("solver.solve_poisson", "most_iterations", params.most_iterations, Range::at_least(0));
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
        GridRows const& rows = grid_rows(widest_lanes());
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
