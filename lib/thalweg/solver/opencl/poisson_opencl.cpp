// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/opencl/internal/poisson_opencl.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/solver/opencl/internal/device_equations.hpp>

namespace thalweg::solver {

namespace {

constexpr char const* poisson_stage = "solver.solve_poisson";

template <class Change> void change_free(GridProblem& problem, Change change) {
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        if (problem.kind[i] == free_cell) {
            problem.value[i] = change(problem.value[i]);
        }
    }
}

/// A power of 2 that brings the problem's numbers near 1, so that their squares stay in range.
double scale_of(Contents const& contents) {
    int exponent = 0;
    std::frexp(contents.size, &exponent); // 0 for 0
    return std::ldexp(1.0, -exponent);
}

/// Iterates until the residual, counted from the values, and what a further cycle would add to them are small enough.
/// Takes: greatest |height| of the fixed cells, scaled as the equations are.
GridSolution iterate(DeviceEquations& equations, double height, PoissonParams const& params, Run const& run) {
    constexpr double unseen = 2.0; // what a cycle may leave of an error beside what it takes
    GridSolution solution;
    double counted = std::numeric_limits<double>::infinity();
    double norm = equations.renew();
    double share = 0.0;
    for (;; ++solution.iterations) {
        if (norm > 0.0) {
            share = std::clamp(portable::log(norm) / portable::log(params.tolerance), share, 1.0);
        }
        run.at(share, "solve");
        equations.precondition();
        if (norm <= params.tolerance) {
            auto const greatest = equations.greatest();
            if (unseen * greatest.correction <= params.tolerance * std::max(height, greatest.value)) {
                norm = equations.renew();
                if (norm <= params.tolerance) {
                    run.at(1.0, "solve");
                    solution.residual = norm;
                    return solution;
                }
                if (norm > 0.5 * counted) {
                    throw NotConverged(fmt::format("{}: the residual stays at {:.3g} of what it was, where double has "
                                                   "no more digits; a tolerance of {:.3g} is out of reach",
                                                   poisson_stage, norm, params.tolerance));
                }
                counted = norm;
                equations.begin_anew();
                equations.precondition();
            }
        }
        if (solution.iterations >= params.most_iterations) {
            throw NotConverged(fmt::format("{}: after {} iterations the residual is {:.3g} of what it was instead of "
                                           "{:.3g}; ask for less or allow more of them",
                                           poisson_stage, solution.iterations, norm, params.tolerance));
        }
        norm = equations.advance();
    }
}

} // namespace

GridSolution solve_poisson_opencl(GridProblem problem, Contents const& contents, PoissonParams const& params,
                                  Run const& run) {
    GridSolution solution;
    if (contents.free > 0) {
        bool const guessed = contents.guesses > 0 && contents.unknown == 0;
        double const scale = scale_of(contents);
        DeviceEquations equations(problem, {guessed, contents.sum / static_cast<double>(contents.fixed), scale},
                                  poisson_stage);
        if (equations.zero_norm() > 0.0) {
            double const height = std::max(std::fabs(contents.least), std::fabs(contents.greatest));
            solution = iterate(equations, height * scale, params, run);
            equations.read_into(problem.value);
            if (problem.source.cells() == 0) {
                change_free(problem,
                            [&](double value) { return std::clamp(value, contents.least, contents.greatest); });
            }
        } else {
            change_free(problem, [](double) { return 0.0; });
        }
    }
    solution.value = std::move(problem.value);
    return solution;
}

} // namespace thalweg::solver
