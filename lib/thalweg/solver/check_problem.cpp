// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/check_problem.hpp>

#include <thalweg/core/error.hpp>
#include <thalweg/core/sum_rows.hpp>
#include <thalweg/solver/unreached.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace thalweg::solver {
namespace {

constexpr auto outside = static_cast<std::uint8_t>(CellKind::outside);
constexpr auto free_cell = static_cast<std::uint8_t>(CellKind::free);
constexpr auto fixed = static_cast<std::uint8_t>(CellKind::fixed);

ProblemContents contents(GridProblem const& problem, Run const& run) {
    bool const laplace = problem.source.cells() == 0;
    std::int64_t const width = problem.kind.width();
    return sum_rows(run, problem.kind.height(), [&](std::int64_t row) {
        ProblemContents c;
        for (std::int64_t i = row * width; i < (row + 1) * width; ++i) {
            double const value = problem.value[i];
            if (problem.kind[i] == fixed) {
                ++c.fixed;
                c.least = std::min(c.least, value);
                c.greatest = std::max(c.greatest, value);
                c.sum += value;
                c.size = std::max(c.size, std::fabs(value));
                c.bad = std::isfinite(value) ? c.bad : std::min(c.bad, i);
            } else if (problem.kind[i] == free_cell) {
                ++c.free;
                c.guesses += value != 0.0 ? 1 : 0;
                c.unknown += std::isfinite(value) ? 0 : 1;
                if (!laplace) {
                    c.size = std::max(c.size, std::fabs(problem.source[i]));
                    c.bad = std::isfinite(problem.source[i]) ? c.bad : std::min(c.bad, i);
                }
            } else {
                ++c.outside;
                c.bad = problem.kind[i] == outside ? c.bad : std::min(c.bad, i);
            }
        }
        return c;
    });
}

void demand(GridProblem const& problem, PoissonParams const& params) {
    if (!(params.tolerance > 0.0 && params.tolerance < 1.0)) {
        throw BadParameter(fmt::format("solver.solve_poisson: a tolerance of {}; it must be greater than 0 and less "
                                       "than 1",
                                       params.tolerance));
    }
    if (params.most_iterations < 0) {
        throw BadParameter(fmt::format("solver.solve_poisson: {} iterations at most; it cannot be less than 0",
                                       params.most_iterations));
    }
    Grid const& grid = problem.kind.grid();
    auto const fits = [&](Grid const& other) { return other.width == grid.width && other.height == grid.height; };
    if (!fits(problem.value.grid()) || (problem.source.cells() > 0 && !fits(problem.source.grid()))) {
        throw BadInput(fmt::format("solver.solve_poisson: kinds of {} x {} cells, values of {} x {}, a source of {} x "
                                   "{}; the three must have one frame",
                                   grid.width, grid.height, problem.value.width(), problem.value.height(),
                                   problem.source.width(), problem.source.height()));
    }
}

void demand_solvable(GridProblem const& problem, ProblemContents const& all, Run const& run) {
    Grid const& grid = problem.kind.grid();
    if (all.bad < grid.cells()) {
        Cell const c = grid.at(all.bad);
        throw BadInput(fmt::format("solver.solve_poisson: the cell at column {}, row {} has the kind {}, the value {} "
                                   "and the source {}; a fixed cell needs a finite value, a free one a finite source",
                                   c.col, c.row, problem.kind[c], problem.value[c],
                                   problem.source.cells() > 0 ? problem.source[c] : 0.0));
    }
    if (all.free > 0 && (all.fixed == 0 || all.outside > 0)) {
        if (auto const lost = unreached(problem.kind, run); !lost.empty()) {
            throw BadInput(fmt::format("solver.solve_poisson: no path leads from the free cell at column {}, row {} to "
                                       "a fixed one; fix a cell of its part or put the part outside",
                                       lost.front().begin, lost.front().row));
        }
    }
}

} // namespace

ProblemContents& ProblemContents::operator+=(ProblemContents const& o) {
    free += o.free;
    fixed += o.fixed;
    outside += o.outside;
    bad = std::min(bad, o.bad);
    guesses += o.guesses;
    unknown += o.unknown;
    least = std::min(least, o.least);
    greatest = std::max(greatest, o.greatest);
    sum += o.sum;
    size = std::max(size, o.size);
    return *this;
}

double ProblemContents::scale() const {
    if (size == 0.0) {
        return 1.0;
    }
    int exponent = 0;
    std::frexp(size, &exponent);
    return std::ldexp(1.0, -exponent);
}

ProblemContents check_problem(GridProblem const& problem, PoissonParams const& params, Run const& run) {
    demand(problem, params);
    run.check();
    ProblemContents const all = contents(problem, run);
    demand_solvable(problem, all, run);
    return all;
}

} // namespace thalweg::solver
