// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The solver on skeletons as the pipeline makes them and as land has them.
#include <thalweg/solver/grid/poisson.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <solver/winding_lines.hpp>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/growth/tokunaga/embed_tree.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/ridges.hpp>
#include <thalweg/solver/grid/internal/poisson.hpp>
#include <thalweg/surface/diffusion/internal/diffusion.hpp>

namespace poisson_test {

using namespace thalweg;
using namespace thalweg::solver;
using test::winding_lines;

namespace {

using test::frame_below;
using test::message_of;
using test::on_threads;
using test::same_bits;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

GridProblem all_free(std::int64_t width, std::int64_t height) {
    return {
        Raster<std::uint8_t>(frame_below(width, height), free_cell), Raster<double>(frame_below(width, height)), {}};
}

void fix(GridProblem& problem, Cell c, double value) {
    problem.kind[c] = fixed_cell;
    problem.value[c] = value;
}

std::vector<Cell> neighbours(GridProblem const& problem, Cell c) {
    std::vector<Cell> near;
    for (Cell const n : {Cell{c.col - 1, c.row}, {c.col + 1, c.row}, {c.col, c.row - 1}, {c.col, c.row + 1}}) {
        if (problem.kind.grid().contains(n) && problem.kind[n] != outside_cell) {
            near.push_back(n);
        }
    }
    return near;
}

/// Cells at random; `share` of them fixed, `holes` outside. Parts without a fixed cell get one.
GridProblem by_chance(std::int64_t width, std::int64_t height, double share, double holes, std::uint64_t seed) {
    GridProblem problem = all_free(width, height);
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        auto const [kind, value, a, b] = random_block(seed, 1, static_cast<std::uint64_t>(i));
        double const u = unit(kind);
        problem.kind[i] = u < share ? fixed_cell : (u < share + holes ? outside_cell : free_cell);
        problem.value[i] = problem.kind[i] == fixed_cell ? 1000.0 * unit(value) : 0.0;
    }
    for (auto lost = unreached(problem.kind); !lost.empty(); lost = unreached(problem.kind)) {
        fix(problem, {lost.front().begin, lost.front().row}, 1000.0 * unit(random_word(seed, 2, lost.size())));
    }
    return problem;
}

/// Rooms with walls of one cell, each with a gap of one cell: two corners are fixed.
GridProblem rooms(std::int64_t side, std::int64_t room, std::int64_t first_wall) {
    GridProblem problem = all_free(side, side);
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        Cell const c = problem.kind.grid().at(i);
        std::int64_t const across = (c.col + room - first_wall) % room;
        std::int64_t const along = (c.row + room - first_wall) % room;
        bool const gap = across == room / 2 || along == room / 2;
        problem.kind[i] = (across == 0 || along == 0) && !gap ? outside_cell : free_cell;
    }
    fix(problem, {1, 1}, 1000.0);
    fix(problem, {side - 2, side - 2}, 0.0);
    return problem;
}

/// Gaussian elimination, with nothing left out: every row of the matrix in full.
std::vector<double> eliminated(GridProblem const& problem) {
    std::vector<std::int64_t> cells;
    std::vector<std::int64_t> number(static_cast<std::size_t>(problem.kind.cells()), -1);
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        if (problem.kind[i] == free_cell) {
            number[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(cells.size());
            cells.push_back(i);
        }
    }
    std::size_t const n = cells.size();
    std::vector<std::vector<double>> a(n, std::vector<double>(n + 1));
    for (std::size_t i = 0; i < n; ++i) {
        a[i][n] = problem.source.cells() > 0 ? problem.source[cells[i]] : 0.0;
        for (Cell const near : neighbours(problem, problem.kind.grid().at(cells[i]))) {
            a[i][i] += 1.0;
            if (problem.kind[near] == fixed_cell) {
                a[i][n] += problem.value[near];
            } else {
                a[i][static_cast<std::size_t>(number[static_cast<std::size_t>(problem.kind.grid().index(near))])] -=
                    1.0;
            }
        }
    }
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t i = k + 1; i < n; ++i) {
            double const times = a[i][k] / a[k][k];
            for (std::size_t j = k; times != 0.0 && j <= n; ++j) {
                a[i][j] -= times * a[k][j];
            }
        }
    }
    std::vector<double> u(problem.value.values().begin(), problem.value.values().end());
    for (std::size_t k = n; k-- > 0;) {
        double sum = a[k][n];
        for (std::size_t j = k + 1; j < n; ++j) {
            sum -= a[k][j] * u[static_cast<std::size_t>(cells[j])];
        }
        u[static_cast<std::size_t>(cells[k])] = sum / a[k][k];
    }
    return u;
}

double greatest_difference(Raster<double> const& a, Raster<double> const& b) {
    double most = 0.0;
    for (std::int64_t i = 0; i < a.cells(); ++i) {
        most = std::max(most, std::fabs(a[i] - b[i]));
    }
    return most;
}

/// Fixed cells of 0 and 1 among others, and all holes isolated: no part is without a fixed cell.
GridProblem random_problem(std::int64_t width, std::int64_t height, std::uint64_t seed) {
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

/// A Tokunaga network of 1024 x 1024 cells, and the ridges between its streams.
Raster<float> rivers_and_ridges(skeleton::RidgesParams::Method method) {
    Grid const grid{1024, 1024, 30.0, 0.0, 30720.0, ""};
    growth::EmbedParams embedding;
    embedding.region = {{600, 600}, {30120, 600}, {30120, 30120}, {600, 30120}};
    embedding.mouth = {15360, 600};
    auto const tree = growth::grow_tokunaga({.generator = 2, .order = 6});
    StreamNetwork const plan = growth::embed_tree(tree, embedding).network;
    ElevatedNetwork const rivers = network::set_heights(plan, {network::HeightMode::along_stream, 0.02}).network;
    skeleton::RidgesParams params;
    params.method = method;
    RidgeLines const ridges = skeleton::ridges(rivers, network::streams(plan, network::order(plan)), grid, params);
    return skeleton::draw_skeleton(network::rasterise(rivers, grid).valley, ridges, {}).skeleton.z;
}

/// The rivers of a DEM: its cells through which the water of a hundred others runs.
Raster<float> streams_of_land() {
    Raster<float> dem = io::read_dem(THALWEG_SOURCE_DIR "/samples/jacksboro_srtm3.tif");
    flow::FlowField const drainage = flow::route(dem);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = drainage.area_cells[i] >= 100 ? dem[i] : std::numeric_limits<float>::quiet_NaN();
    }
    return dem;
}

void expect_solved(Raster<float> const& z, int most_iterations) {
    GridProblem const problem = surface::problem_through(z, {}, "test", {});
    float least = std::numeric_limits<float>::infinity();
    float greatest = -least;
    std::int64_t fixed = 0;
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        if (!std::isnan(z[i])) {
            ++fixed;
            least = std::min(least, z[i]);
            greatest = std::max(greatest, z[i]);
        }
    }
    GridSolution const quick = solve_poisson(problem, {1e-6, 1000});
    GridSolution const exact = solve_poisson(problem, {1e-12, 1000});
    double most = 0.0;
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        most = std::max(most, std::fabs(quick.value[i] - exact.value[i]));
        ASSERT_TRUE(quick.value[i] >= least && quick.value[i] <= greatest);
        ASSERT_TRUE(std::isnan(z[i]) || quick.value[i] == static_cast<double>(z[i]));
    }
    std::printf("%lld x %lld cells, %.2f %% fixed, %.0f to %.0f m: %d iterations to 1e-6, %d to 1e-12, error %.2g m\n",
                static_cast<long long>(z.width()), static_cast<long long>(z.height()),
                100.0 * static_cast<double>(fixed) / static_cast<double>(z.cells()), least, greatest, quick.iterations,
                exact.iterations, most);
    EXPECT_LE(most, 1e-3);
    EXPECT_LE(quick.iterations, most_iterations);
}

} // namespace

TEST(Poisson, NothingToDo) {
    EXPECT_EQ(solve_poisson({}).iterations, 0);
    GridProblem problem = all_free(1, 1);
    problem.kind[0] = outside_cell;
    problem.value[0] = nan;
    EXPECT_TRUE(std::isnan(solve_poisson(problem).value[0]));
    fix(problem, {0, 0}, -0.0);
    EXPECT_TRUE(std::signbit(solve_poisson(problem).value[0]));
    GridProblem zero = all_free(5, 4);
    fix(zero, {2, 2}, 0.0);
    GridSolution const solution = solve_poisson(zero);
    EXPECT_EQ(solution.residual, 0.0);
    EXPECT_EQ(std::count(solution.value.values().begin(), solution.value.values().end(), 0.0), 20);
}

TEST(Poisson, RefusesWhatHasNoSolution) {
    GridProblem problem = all_free(7, 5);
    EXPECT_TRUE(test::has(message_of<BadInput>([&] { solve_poisson(problem); }), "column 0, row 0"));
    fix(problem, {0, 0}, 1.0);
    for (std::int64_t row = 0; row < 5; ++row) {
        problem.kind[{4, row}] = outside_cell; // a wall
    }
    EXPECT_TRUE(test::has(message_of<BadInput>([&] { solve_poisson(problem); }), "column 5, row 0"));
    fix(problem, {6, 4}, 1.0);
    EXPECT_NO_THROW(solve_poisson(problem));
    for (PoissonParams const& bad : {PoissonParams{0.0, 9}, {1.0, 9}, {nan, 9}, {1e-6, -1}}) {
        EXPECT_THROW(solve_poisson(problem, bad), BadParameter);
    }
    fix(problem, {2, 3}, nan);
    EXPECT_TRUE(test::has(message_of<BadInput>([&] { solve_poisson(problem); }), "column 2, row 3"));
    fix(problem, {2, 3}, 2.0);
    problem.source = Raster<double>(problem.kind.grid());
    problem.source[{3, 3}] = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(test::has(message_of<BadInput>([&] { solve_poisson(problem); }), "column 3, row 3"));
    problem.source = Raster<double>(frame_below(5, 7));
    EXPECT_THROW(solve_poisson(problem), BadInput);
    problem.source = {};
    problem.kind[{1, 1}] = 3;
    EXPECT_TRUE(test::has(message_of<BadInput>([&] { solve_poisson(problem); }), "column 1, row 1"));
}

TEST(Poisson, SaysWhenItHasNotConverged) {
    GridProblem const problem = by_chance(60, 60, 0.02, 0.0, 3);
    EXPECT_THROW(solve_poisson(problem, {1e-8, 2}), NotConverged);
    EXPECT_THROW(solve_poisson(problem, {1e-30, 100000}), NotConverged);
}

TEST(Poisson, AgreesWithElimination) {
    ASSERT_TRUE(rc::check("any cells, holes, source and first guess", [] {
        auto const width = *rc::gen::inRange<std::int64_t>(1, 20).as("width");
        auto const height = *rc::gen::inRange<std::int64_t>(1, 20).as("height");
        double const share = *rc::gen::element(0.0, 0.02, 0.1, 0.6).as("share of fixed cells");
        double const holes = *rc::gen::element(0.0, 0.1, 0.4).as("share outside");
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        bool const pushed = *rc::gen::element(false, true).as("source");
        bool const guessed = *rc::gen::element(false, true).as("guess");
        GridProblem problem = by_chance(width, height, share, holes, seed);
        if (pushed) {
            problem.source = Raster<double>(problem.kind.grid());
        }
        for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
            auto const place = static_cast<std::uint64_t>(i);
            if (pushed) {
                problem.source[i] = 100.0 * (unit(random_word(seed, 5, place)) - 0.5);
            }
            if (guessed && problem.kind[i] == free_cell) {
                problem.value[i] = 1000.0 * unit(random_word(seed, 6, place));
            }
        }
        GridSolution const solution = solve_poisson(problem, {1e-12, 1000});
        auto const expected = eliminated(problem);
        double most = 1000.0;
        for (double const u : expected) {
            most = std::max(most, std::fabs(u));
        }
        RC_ASSERT(solution.residual <= 1e-12);
        for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
            if (problem.kind[i] == free_cell) {
                RC_ASSERT(std::fabs(solution.value[i] - expected[static_cast<std::size_t>(i)]) <= 1e-10 * most);
            } else {
                RC_ASSERT(std::bit_cast<std::uint64_t>(solution.value[i]) ==
                          std::bit_cast<std::uint64_t>(problem.value[i]));
            }
        }
    }));
}

TEST(Poisson, KeepsTheMaximumPrinciple) {
    ASSERT_TRUE(rc::check("values lie between the least and the greatest fixed one, at any tolerance", [] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        double const tolerance = *rc::gen::element(0.5, 1e-2, 1e-6, 1e-12).as("tolerance");
        GridProblem const problem = by_chance(70, 40, 0.02, 0.2, seed);
        double least = 1e9;
        double greatest = -1e9;
        for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
            if (problem.kind[i] == fixed_cell) {
                least = std::min(least, problem.value[i]);
                greatest = std::max(greatest, problem.value[i]);
            }
        }
        GridSolution const solution = solve_poisson(problem, {tolerance, 1000});
        for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
            RC_ASSERT(problem.kind[i] != free_cell || (solution.value[i] >= least && solution.value[i] <= greatest));
        }
    }));
}

TEST(Poisson, PlanesAreKept) {
    for (auto const& [width, height] : {std::pair<int, int>{64, 64}, {33, 90}, {3, 3}, {17, 1}, {1, 18}}) {
        GridProblem problem = all_free(width, height);
        auto const plane = [](Cell c) {
            return 100.0 + 3.0 * static_cast<double>(c.col) - 2.0 * static_cast<double>(c.row);
        };
        for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
            Cell const c = problem.kind.grid().at(i);
            bool const rim =
                width > 1 && height > 1 ? problem.kind.grid().on_border(c) : (i == 0 || i + 1 == problem.kind.cells());
            if (rim) {
                fix(problem, c, plane(c));
            }
        }
        GridSolution const solution = solve_poisson(problem, {1e-12, 1000});
        for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
            EXPECT_NEAR(solution.value[i], plane(problem.kind.grid().at(i)), 1e-9);
        }
    }
}

TEST(Poisson, SameBytesForAnyThreadsAndLanes) {
    GridProblem problem = by_chance(701, 333, 0.02, 0.05, 4);
    GridSolution const one = solve_poisson(problem, {1e-8, 100}, on_threads(1));
    for (int const threads : {2, 3, 8}) {
        EXPECT_TRUE(same_bits(solve_poisson(problem, {1e-8, 100}, on_threads(threads)).value, one.value));
    }
    GridProblem const large = winding_lines(2048, 0.035); // coarser levels of several ranges of rows
    Raster<double> const alone = solve_poisson(large, {1e-2, 100}, on_threads(1)).value;
    for (int const threads : {2, 3, 4}) {
        EXPECT_TRUE(same_bits(solve_poisson(large, {1e-2, 100}, on_threads(threads)).value, alone));
    }
    std::vector<Raster<double>> values;
    for (Lanes const lanes : {Lanes::plain, widest_lanes()}) {
        ColouredProblem iterate = coloured(problem, survey_problem(problem, "test", {}), {});
        auto levels = coarse_levels(problem.kind, {});
        double const zero = residual_norm(iterate, grid_rows(lanes), {});
        conjugate_gradients(iterate, levels, zero, {1e-8, 100}, grid_rows(lanes), {});
        values.emplace_back(problem.kind.grid());
        for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
            Cell const c = problem.kind.grid().at(i);
            values.back()[i] = iterate.x.of[(c.col + c.row) & 1].row(c.row)[c.col / 2];
        }
    }
    EXPECT_TRUE(same_bits(values[0], values[1]));
}

TEST(Poisson, IterationsDoNotGrowWithTheGrid) {
    auto const iterations = [](GridProblem problem) {
        return solve_poisson(std::move(problem), {1e-6, 100}).iterations;
    };
    for (double const share : {0.01, 0.05}) {
        int const few = iterations(by_chance(512, 512, share, 0.0, 1));
        int const many = iterations(by_chance(1024, 1024, share, 0.0, 1));
        EXPECT_LE(std::abs(many - few), 3) << share;
    }
    int const on_lines = iterations(winding_lines(512, 0.035));
    EXPECT_LE(on_lines, 9);
    for (std::int64_t const side : {1024, 2048}) {
        EXPECT_LE(std::abs(iterations(winding_lines(side, 0.035)) - on_lines), 1) << side;
    }
}

TEST(Poisson, GapsBetweenRoomsTakeFewIterations) {
    // Some walls lie on borders of the coarser levels' cells, on all levels.
    for (std::int64_t const first_wall : {0, 7, 15, 31}) {
        for (std::int64_t const room : {32, 64}) {
            GridProblem const problem = rooms(512, room, first_wall);
            GridSolution const quick = solve_poisson(problem, {1e-6, 20});
            EXPECT_LE(greatest_difference(quick.value, solve_poisson(problem, {1e-11, 40}).value), 1e-3)
                << first_wall << " " << room;
        }
    }
}

TEST(Poisson, WithinAMillimetreAtOneMillionth) {
    std::vector<GridProblem> problems = {winding_lines(300, 0.035), by_chance(300, 300, 0.01, 0.0, 1),
                                         all_free(300, 300)};
    fix(problems[2], {0, 0}, 1000.0);
    fix(problems[2], {299, 299}, 0.0);
    for (GridProblem const& problem : problems) {
        Raster<double> const exact = solve_poisson(problem, {1e-12, 1000}).value;
        EXPECT_LE(greatest_difference(solve_poisson(problem, {1e-6, 1000}).value, exact), 1e-3);
    }
}

TEST(Poisson, AnyUnitOfHeight) {
    GridProblem problem = winding_lines(100, 0.03);
    Raster<double> const metres = solve_poisson(problem, {1e-10, 100}).value;
    for (double const unit_m : {0x1p-60, 0x1p40}) { // powers of two: every bit but the exponent's
        GridProblem other = problem;
        for (double& z : other.value.values()) {
            z *= unit_m;
        }
        Raster<double> solved = solve_poisson(other, {1e-10, 100}).value;
        for (double& z : solved.values()) {
            z /= unit_m;
        }
        EXPECT_TRUE(same_bits(solved, metres));
    }
}

TEST(Poisson, TellsHowFarItIsAndStops) {
    GridProblem const problem = winding_lines(200, 0.03);
    std::vector<double> shares;
    thalweg::Run run;
    run.progress_arg = &shares;
    run.progress = [](double share, char const*, void* to) {
        static_cast<std::vector<double>*>(to)->push_back(share);
        return 1;
    };
    solve_poisson(problem, {}, run);
    ASSERT_GT(shares.size(), 5U);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1.0);
    run.progress = [](double share, char const*, void*) { return share < 0.3 ? 1 : 0; };
    EXPECT_THROW(solve_poisson(problem, {}, run), Cancelled);
    std::stop_source stopped;
    stopped.request_stop();
    thalweg::Run stop;
    stop.stop = stopped.get_token();
    EXPECT_THROW(solve_poisson(problem, {}, stop), Cancelled);
}

TEST(Unreached, FindsPartsWithoutFixedCells) {
    ASSERT_TRUE(rc::check("as a flood from the fixed cells does", [] {
        auto const width = *rc::gen::inRange<std::int64_t>(1, 25).as("width");
        auto const height = *rc::gen::inRange<std::int64_t>(1, 25).as("height");
        double const holes = *rc::gen::element(0.0, 0.3, 0.5).as("share outside");
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        GridProblem problem = all_free(width, height);
        for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
            double const u = unit(random_word(seed, 1, static_cast<std::uint64_t>(i)));
            problem.kind[i] = u < 0.02 ? fixed_cell : (u < 0.02 + holes ? outside_cell : free_cell);
        }
        Mask reached(problem.kind.grid(), 0);
        for (bool changed = true; changed;) {
            changed = false;
            for (std::int64_t i = 0; i < reached.cells(); ++i) {
                bool now = problem.kind[i] == fixed_cell;
                for (Cell const n : neighbours(problem, problem.kind.grid().at(i))) {
                    now = now || reached[n] != 0;
                }
                if (now && reached[i] == 0 && problem.kind[i] != outside_cell) {
                    reached[i] = 1;
                    changed = true;
                }
            }
        }
        Mask found(problem.kind.grid(), 0);
        for (CellSpan const& span : unreached(problem.kind)) {
            RC_ASSERT(span.begin < span.end);
            for (std::int64_t col = span.begin; col < span.end; ++col) {
                RC_ASSERT((found[{col, span.row}] == 0));
                found[{col, span.row}] = 1;
            }
        }
        for (std::int64_t i = 0; i < reached.cells(); ++i) {
            RC_ASSERT((found[i] != 0) == (problem.kind[i] != outside_cell && reached[i] == 0));
        }
    }));
}

TEST(RelaxExplicit, RefusesWhatGrows) {
    GridProblem problem = random_problem(9, 9, 1);
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
        GridProblem const problem = random_problem(width, height, seed);
        Raster<double> const expected = swept(problem, alpha, sweeps);
        GridSolution const solution = relax_explicit(problem, {alpha, sweeps});
        RC_ASSERT(solution.iterations == sweeps);
        for (std::int64_t i = 0; i < expected.cells(); ++i) {
            RC_ASSERT(std::fabs(solution.value[i] - expected[i]) <= 1e-13);
        }
    }));
}

TEST(RelaxExplicit, TendsToTheSolution) {
    GridProblem const problem = random_problem(64, 64, 5);
    Raster<double> const steady = solve_poisson(problem, {1e-12, 1000}).value;
    GridSolution const solution = relax_explicit(problem, {0.25, 20000});
    EXPECT_LE(solution.residual, 1e-10);
    for (std::int64_t i = 0; i < steady.cells(); ++i) {
        EXPECT_NEAR(solution.value[i], steady[i], 1e-6);
    }
}

TEST(RelaxExplicit, SameBytesForAnyThreads) {
    GridProblem const problem = random_problem(301, 203, 6);
    thalweg::Run run = on_threads(1);
    Raster<double> const one = relax_explicit(problem, {0.25, 21}, run).value;
    for (int const threads : {2, 5}) {
        run.threads = threads;
        Raster<double> const more = relax_explicit(problem, {0.25, 21}, run).value;
        EXPECT_EQ(std::memcmp(more.values().data(), one.values().data(), one.values().size_bytes()), 0);
    }
}

TEST(PoissonOnSkeletons, RiversAndRidges) {
    expect_solved(rivers_and_ridges(skeleton::RidgesParams::Method::voronoi), 25);
    expect_solved(rivers_and_ridges(skeleton::RidgesParams::Method::segments), 25);
}

TEST(PoissonOnSkeletons, StreamsOfLand) {
    expect_solved(streams_of_land(), 25);
}

} // namespace poisson_test
