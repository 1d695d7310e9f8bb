// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/poisson.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace relax_explicit_test {

using namespace thalweg;
using namespace thalweg::solver;

namespace {

using test::on_threads;

/// Fixed cells of 0 and 1 among others, and all holes isolated: no part is without a fixed cell.
GridProblem by_chance(std::int64_t width, std::int64_t height, std::uint64_t seed) {
    Grid const grid{width, height, 1.0, 0.0, 0.0, ""};
    GridProblem problem{Raster<std::uint8_t>(grid, free_cell), Raster<double>(grid), {}};
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        auto const words = random_block(seed, 1, static_cast<std::uint64_t>(i));
        bool const hole = c.col % 2 == 1 && c.row % 2 == 1 && unit(words[0]) < 0.3;
        problem.kind[i] = hole ? outside_cell : (unit(words[1]) < 0.05 ? fixed_cell : free_cell);
        problem.value[i] = unit(words[2]);
    }
    problem.kind[0] = fixed_cell;
    problem.value[0] = 0.0;
    problem.kind[grid.cells() - 1] = fixed_cell;
    problem.value[grid.cells() - 1] = 1.0;
    return problem;
}

/// The formula, cell by cell.
Raster<double> swept(GridProblem const& problem, double alpha, int sweeps) {
    Raster<double> u = problem.value;
    Grid const& grid = u.grid();
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        Raster<double> next = u;
        for (std::int64_t i = 0; i < u.cells(); ++i) {
            Cell const c = grid.at(i);
            double sum = 0.0;
            for (Cell const n : {Cell{c.col - 1, c.row}, {c.col + 1, c.row}, {c.col, c.row - 1}, {c.col, c.row + 1}}) {
                sum += grid.contains(n) && problem.kind[n] != outside_cell ? u[n] - u[i] : 0.0;
            }
            next[i] += problem.kind[i] == free_cell ? alpha * sum : 0.0;
        }
        u = next;
    }
    return u;
}

TEST(RelaxExplicit, RefusesWhatGrows) {
    GridProblem problem = by_chance(9, 9, 1);
    for (double const alpha : {0.26, 0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(relax_explicit(problem, {alpha, 1}), BadParameter);
    }
    EXPECT_THROW(relax_explicit(problem, {0.25, -1}), BadParameter);
    problem.source = Raster<double>(problem.kind.grid());
    EXPECT_THROW(relax_explicit(problem, {0.25, 1}), BadInput);
    problem.source = {};
    auto const gap = std::find(problem.kind.values().begin(), problem.kind.values().end(), free_cell);
    problem.value[gap - problem.kind.values().begin()] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(relax_explicit(problem, {0.25, 1}), BadInput);
    EXPECT_EQ(relax_explicit({}, {0.25, 3}).value.cells(), 0);
}

TEST(RelaxExplicit, IsTheFormula) {
    ASSERT_TRUE(rc::check("any size, alpha and number of sweeps", [] {
        auto const width = *rc::gen::inRange<std::int64_t>(2, 40).as("width");
        auto const height = *rc::gen::inRange<std::int64_t>(2, 130).as("height");
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        int const sweeps = *rc::gen::inRange(0, 15).as("sweeps");
        double const alpha = *rc::gen::element(0.25, 0.11).as("alpha");
        GridProblem const problem = by_chance(width, height, seed);
        Raster<double> const expected = swept(problem, alpha, sweeps);
        GridSolution const solution = relax_explicit(problem, {alpha, sweeps});
        RC_ASSERT(solution.iterations == sweeps);
        for (std::int64_t i = 0; i < expected.cells(); ++i) {
            RC_ASSERT(std::fabs(solution.value[i] - expected[i]) <= 1e-13);
        }
    }));
}

TEST(RelaxExplicit, TendsToTheSolution) {
    GridProblem const problem = by_chance(64, 64, 5);
    Raster<double> const steady = solve_poisson(problem, {1e-12, 1000}).value;
    GridSolution const solution = relax_explicit(problem, {0.25, 20000});
    EXPECT_LE(solution.residual, 1e-10);
    for (std::int64_t i = 0; i < steady.cells(); ++i) {
        EXPECT_NEAR(solution.value[i], steady[i], 1e-6);
    }
}

TEST(RelaxExplicit, SameBytesForAnyThreads) {
    GridProblem const problem = by_chance(301, 203, 6);
    thalweg::Run run = on_threads(1);
    Raster<double> const one = relax_explicit(problem, {0.25, 21}, run).value;
    for (int const threads : {2, 5}) {
        run.threads = threads;
        Raster<double> const more = relax_explicit(problem, {0.25, 21}, run).value;
        EXPECT_EQ(std::memcmp(more.values().data(), one.values().data(), one.values().size_bytes()), 0);
    }
}

} // namespace

} // namespace relax_explicit_test
