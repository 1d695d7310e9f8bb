// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/poisson.hpp>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/solver/opencl/devices.hpp>
#include <thalweg/solver/opencl/internal/device.hpp>
#include <thalweg/solver/opencl/internal/opencl.hpp>

namespace opencl_test {

using namespace thalweg;
using solver::CellKind;
using solver::GridProblem;

// Without an OpenCL device these tests fail: pocl-opencl-icd is one.
namespace {

using test::frame_below;
using test::full_message_of;
using test::same_bits;

constexpr std::uint8_t outside = 0;
constexpr std::uint8_t free_cell = 1;
constexpr std::uint8_t fixed = 2;

Run on_device() {
    Run run;
    run.device = Device::opencl;
    return run;
}

/// Heights to 1000 m at some cells, others outside; every other seed has sources. All free cells are part of the same
/// land as a fixed one: those that are not are outside.
GridProblem random_problem(std::int64_t width, std::int64_t height, std::uint64_t seed, double fixed_share,
                           double outside_share) {
    Grid const grid = frame_below(width, height);
    GridProblem problem{Raster<std::uint8_t>(grid, free_cell), Raster<double>(grid, 0.0), Raster<double>()};
    if (seed % 2 == 1) {
        problem.source = Raster<double>(grid, 0.0);
    }
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        auto const cell = static_cast<std::uint64_t>(i);
        double const kind = unit(random_word(seed, cell, 1));
        problem.kind[i] = kind < fixed_share ? fixed : kind < fixed_share + outside_share ? outside : free_cell;
        problem.value[i] = problem.kind[i] == outside ? std::numeric_limits<double>::quiet_NaN()
                                                      : 1000.0 * unit(random_word(seed, cell, 2));
        if (problem.source.cells() > 0) {
            problem.source[i] = unit(random_word(seed, cell, 3)) - 0.5;
        }
    }
    std::vector<std::uint8_t> wet(static_cast<std::size_t>(grid.cells()), 0);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            Cell const c = grid.at(i);
            auto& here = wet[static_cast<std::size_t>(i)];
            if (here != 0 || problem.kind[i] == outside) {
                continue;
            }
            here = problem.kind[i] == fixed ? 1 : 0;
            for (Cell const n :
                 {Cell{c.col - 1, c.row}, Cell{c.col + 1, c.row}, Cell{c.col, c.row - 1}, Cell{c.col, c.row + 1}}) {
                here |= grid.contains(n) ? wet[static_cast<std::size_t>(grid.index(n))] : std::uint8_t{0};
            }
            changed = changed || here != 0;
        }
    }
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        problem.kind[i] = wet[static_cast<std::size_t>(i)] == 0 ? outside : problem.kind[i];
    }
    return problem;
}

double greatest_difference(GridProblem const& problem, Raster<double> const& a, Raster<double> const& b) {
    double most = 0.0;
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        if (problem.kind[i] == free_cell) {
            double const difference = std::abs(a[i] - b[i]);
            most = difference <= most ? most : difference; // NaN stays
        } else {
            EXPECT_TRUE(same_bits(a[i], problem.value[i]) && same_bits(b[i], problem.value[i])) << i;
        }
    }
    return most;
}

/// Paper 003's sweeps as they are written down.
void plain_sweeps(GridProblem& problem, double alpha, int sweeps) {
    Grid const& grid = problem.kind.grid();
    for (int s = 0; s < sweeps; ++s) {
        Raster<double> const before = problem.value;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (problem.kind[i] != free_cell) {
                continue;
            }
            Cell const c = grid.at(i);
            double count = 0.0;
            auto const at = [&](std::int64_t col, std::int64_t row) {
                bool const open = grid.contains({col, row}) && problem.kind[Cell{col, row}] != outside;
                count += open ? 1.0 : 0.0;
                return open ? before[Cell{col, row}] : 0.0;
            };
            double const along_row = at(c.col - 1, c.row) + at(c.col + 1, c.row);
            double const along_column = at(c.col, c.row - 1) + at(c.col, c.row + 1);
            problem.value[i] = before[i] + alpha * (along_row + along_column - count * before[i]);
        }
    }
}

/// Sets a variable of the environment for as long as it lives.
class Setting {
public:
    Setting(char const* name, char const* value) : name_(name) {
        if (char const* const before = std::getenv(name); before != nullptr) {
            before_ = before;
            was_set_ = true;
        }
        setenv(name, value, 1);
    }
    ~Setting() {
        if (was_set_) {
            setenv(name_, before_.c_str(), 1);
        } else {
            unsetenv(name_);
        }
    }
    Setting(Setting const&) = delete;
    Setting& operator=(Setting const&) = delete;

private:
    char const* name_;
    std::string before_;
    bool was_set_ = false;
};

} // namespace

TEST(OpenCl, NamesItsDevices) {
    auto const lines = solver::opencl_devices();
    ASSERT_FALSE(lines.empty()) << "install pocl-opencl-icd";
    EXPECT_EQ(lines.front().rfind("0:0 ", 0), 0U) << lines.front();
    std::string const name = solver::opencl_device_name();
    EXPECT_FALSE(name.empty());
    EXPECT_EQ(name, solver::opencl_device().name);
    Setting const first("THALWEG_OPENCL_DEVICE", "0:0");
    EXPECT_TRUE(test::has(lines.front(), solver::opencl_device_name()));
    EXPECT_EQ(&solver::opencl_device(), &solver::opencl_device()) << "one for the life of the process";
}

TEST(OpenCl, RefusesDevicesThatAreNot) {
    for (char const* const wrong : {"7:7", "gpu", "", "0", "0:0:0", "0:", "-1:0"}) {
        Setting const bad("THALWEG_OPENCL_DEVICE", wrong);
        std::string const words = full_message_of<BadParameter>([] { solver::opencl_device_name(); });
        EXPECT_TRUE(test::has(words, "names no device: write platform:device as in 0:0 "));
        GridProblem const problem = random_problem(9, 9, 2, 0.3, 0.0);
        EXPECT_THROW(solver::relax_explicit(problem, {.sweeps = 1}, on_device()), BadParameter);
        EXPECT_THROW(solver::solve_poisson(problem, {}, on_device()), BadParameter);
    }
}

TEST(OpenCl, SaysWhatTheCompilerSays) {
    std::string const words = full_message_of<IoError>([] { solver::DeviceQueue("solver.test", "#error wombat"); });
    EXPECT_TRUE(test::has(words, "solver.test: ", "wombat"));
    std::string const unknown = full_message_of<IoError>([] {
        solver::DeviceQueue queue("solver.test", "kernel void f(int i) {}");
        queue.run("g", 1, 1, 1);
    });
    EXPECT_TRUE(test::has(unknown, "CL_INVALID_KERNEL_NAME"));
}

TEST(OpenCl, RefusesWhatDoesNotFit) {
    solver::OpenClDevice device;
    device.name = "tiny";
    device.memory_bytes = 3'000'000'000;
    device.largest_block_bytes = 1'000'000'000;
    EXPECT_NO_THROW(solver::check_device_memory(device, "solver.test", 3'000'000'000, 1'000'000'000));
    std::string const words = full_message_of<IoError>(
        [&] { solver::check_device_memory(device, "solver.test", 5'500'000'000, 900'000'000); });
    EXPECT_EQ(words,
              "solver.test: the grid needs 5.5 GB in blocks of up to 0.9 GB on the OpenCL device tiny, which has "
              "3.0 GB in blocks of up to 1.0 GB: make the grid smaller or leave --device out");
    EXPECT_THROW(solver::check_device_memory(device, "solver.test", 2'000'000'000, 1'000'000'001), IoError);
}

TEST(OpenClPoisson, OfNothingOfOneCellAndOfRows) {
    EXPECT_EQ(solver::solve_poisson({}, {}, on_device()).value.cells(), 0);
    for (std::int64_t const length : {1, 2, 3, 17, 70}) {
        for (int const turned : {0, 1}) {
            Grid const grid = turned == 1 ? frame_below(1, length) : frame_below(length, 1);
            GridProblem problem{Raster<std::uint8_t>(grid, free_cell), Raster<double>(grid, 0.0), Raster<double>()};
            problem.kind[0] = fixed;
            problem.value[0] = 100.0;
            problem.kind[length - 1] = fixed;
            problem.value[length - 1] = 300.0;
            Raster<double> const value = solver::solve_poisson(problem, {}, on_device()).value;
            for (std::int64_t i = 0; i < length; ++i) {
                double const share = length == 1 ? 1.0 : static_cast<double>(i) / static_cast<double>(length - 1);
                EXPECT_NEAR(value[i], 100.0 + 200.0 * share, 1e-6) << length << " " << i;
            }
        }
    }
}

TEST(OpenClPoisson, BeginsAtAGuessWhereThereIsOne) {
    GridProblem problem = random_problem(60, 60, 2, 0.05, 0.0);
    auto const first = solver::solve_poisson(problem, {}, on_device());
    problem.value = first.value;
    EXPECT_LE(solver::solve_poisson(problem, {}, on_device()).iterations, 1);
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        if (problem.kind[i] == free_cell) {
            problem.value[i] = std::numeric_limits<double>::quiet_NaN(); // tells nothing
        }
    }
    auto const blind = solver::solve_poisson(problem, {}, on_device());
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        ASSERT_NEAR(blind.value[i], first.value[i], 1e-6);
    }
}

TEST(OpenClPoisson, OfHeightsThatAreAllZero) {
    GridProblem problem = random_problem(20, 20, 4, 0.1, 0.0);
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        problem.value[i] = problem.kind[i] == fixed ? 0.0 : problem.value[i];
    }
    auto const solution = solver::solve_poisson(problem, {}, on_device());
    for (double const v : solution.value.values()) {
        EXPECT_EQ(v, 0.0);
    }
}

TEST(OpenClPoisson, RefusesBadProblems) {
    auto const solve = [](GridProblem const& problem, solver::PoissonParams const& params = {}) {
        return solver::solve_poisson(problem, params, on_device());
    };
    GridProblem const good = random_problem(12, 9, 2, 0.2, 0.0);
    EXPECT_NO_THROW(solve(good));
    GridProblem strange = good;
    strange.kind[7] = 3;
    EXPECT_THROW(solve(strange), BadInput);
    GridProblem dry = good;
    for (std::int64_t row = 0; row < 9; ++row) {
        dry.kind[Cell{5, row}] = outside;
        for (std::int64_t col = 6; col < 12; ++col) {
            dry.kind[Cell{col, row}] = free_cell;
        }
    }
    EXPECT_TRUE(test::has(full_message_of<BadInput>([&] { solve(dry); }), "column 6, row 0"));
    GridProblem hole = good;
    hole.kind[Cell{3, 2}] = fixed;
    hole.value[Cell{3, 2}] = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(test::has(full_message_of<BadInput>([&] { solve(hole); }), "column 3, row 2"));
    GridProblem other_size = good;
    other_size.value = Raster<double>(frame_below(9, 12));
    EXPECT_THROW(solve(other_size), BadInput);
    GridProblem odd_source = good;
    odd_source.source = Raster<double>(frame_below(3, 3));
    EXPECT_THROW(solve(odd_source), BadInput);
    for (double const tolerance : {0.0, -1.0, 1.0, std::nan("")}) {
        EXPECT_THROW(solve(good, {.tolerance = tolerance}), BadParameter);
    }
    EXPECT_THROW(solve(good, {.most_iterations = -1}), BadParameter);
    EXPECT_THROW(solve(random_problem(80, 80, 2, 0.01, 0.0), {.most_iterations = 2}), NotConverged);
    EXPECT_TRUE(test::has(
        full_message_of<NotConverged>([&] { solve(random_problem(80, 80, 2, 0.01, 0.0), {.tolerance = 1e-18}); }),
        "out of reach"));
}

TEST(OpenClPoisson, AgreesWithTheProcessor) {
    struct Case {
        std::int64_t width, height;
        std::uint64_t seed;
        double fixed_share, outside_share;
    };
    for (Case const& c : {Case{300, 200, 2, 0.01, 0.0}, Case{255, 257, 3, 0.02, 0.3}, Case{64, 64, 5, 0.05, 0.4},
                          Case{33, 500, 6, 0.01, 0.1}, Case{401, 90, 7, 0.003, 0.2}}) {
        GridProblem const problem = random_problem(c.width, c.height, c.seed, c.fixed_share, c.outside_share);
        auto const here = solver::solve_poisson(problem, {.tolerance = 1e-10});
        auto const there = solver::solve_poisson(problem, {.tolerance = 1e-10}, on_device());
        EXPECT_LE(greatest_difference(problem, here.value, there.value), 1e-6) << c.width << " x " << c.height;
        EXPECT_LE(there.residual, 1e-10);
        EXPECT_GT(there.iterations, 0);
        EXPECT_LE(there.iterations, c.outside_share > 0.1 ? 80 : 30) << c.width << " x " << c.height;
    }
}

RC_GTEST_PROP(OpenClPoisson, AgreesOnSmallGrids, ()) {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 40);
    auto const height = *rc::gen::inRange<std::int64_t>(1, 40);
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1000);
    auto const outside_share = *rc::gen::element(0.0, 0.2, 0.5);
    GridProblem const problem = random_problem(width, height, seed, 0.1, outside_share);
    auto const here = solver::solve_poisson(problem, {.tolerance = 1e-12});
    auto const there = solver::solve_poisson(problem, {.tolerance = 1e-12}, on_device());
    RC_ASSERT(greatest_difference(problem, here.value, there.value) <= 1e-6);
}

TEST(OpenClPoisson, StaysBetweenTheFixedHeights) {
    GridProblem const problem = random_problem(90, 70, 8, 0.02, 0.1);
    double least = 1e9;
    double greatest = -1e9;
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        if (problem.kind[i] == fixed) {
            least = std::min(least, problem.value[i]);
            greatest = std::max(greatest, problem.value[i]);
        }
    }
    auto const rough = solver::solve_poisson(problem, {.tolerance = 0.05}, on_device());
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        if (problem.kind[i] == free_cell) {
            ASSERT_TRUE(rough.value[i] >= least && rough.value[i] <= greatest) << rough.value[i];
        }
    }
}

TEST(OpenClPoisson, GivesTheSameBitsEachTime) {
    GridProblem const problem = random_problem(200, 150, 9, 0.02, 0.1);
    auto const one = solver::solve_poisson(problem, {}, on_device());
    auto const two = solver::solve_poisson(problem, {}, on_device());
    EXPECT_EQ(one.iterations, two.iterations);
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        ASSERT_TRUE(same_bits(one.value[i], two.value[i])) << i;
    }
}

TEST(OpenClPoisson, StopsWhenAskedTo) {
    std::stop_source stop;
    stop.request_stop();
    thalweg::Run run = on_device();
    run.stop = stop.get_token();
    EXPECT_THROW(solver::solve_poisson(random_problem(50, 50, 2, 0.02, 0.0), {}, run), Cancelled);
    EXPECT_NO_THROW(solver::solve_poisson(random_problem(50, 50, 2, 0.02, 0.0), {}, on_device()));
}

TEST(OpenClRelax, OfNothing) {
    EXPECT_EQ(solver::relax_explicit({}, {}, on_device()).value.cells(), 0);
    GridProblem one = random_problem(1, 1, 2, 1.0, 0.0);
    EXPECT_TRUE(same_bits(solver::relax_explicit(one, {}, on_device()).value[0], one.value[0]));
    GridProblem all = random_problem(9, 9, 2, 0.2, 0.1);
    auto const still = solver::relax_explicit(all, {.sweeps = 0}, on_device());
    for (std::int64_t i = 0; i < all.kind.cells(); ++i) {
        EXPECT_TRUE(all.kind[i] == free_cell || same_bits(still.value[i], all.value[i]));
    }
}

TEST(OpenClRelax, RefusesWhatGrowsWithoutEnd) {
    GridProblem const problem = random_problem(5, 5, 2, 0.3, 0.0);
    EXPECT_THROW(solver::relax_explicit(problem, {.alpha = 0.2500001}, on_device()), BadParameter);
    EXPECT_THROW(solver::relax_explicit(problem, {.sweeps = -1}, on_device()), BadParameter);
}

RC_GTEST_PROP(OpenClRelax, HasTheBitsOfThePlainSum, ()) {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 150);
    auto const height = *rc::gen::inRange<std::int64_t>(1, 60);
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1000);
    auto const alpha = *rc::gen::element(0.25, 0.2, 0.1, 1.0 / 3.0 - 0.1);
    auto const sweeps = *rc::gen::inRange(0, 20);
    auto const outside_share = *rc::gen::element(0.0, 0.3);
    GridProblem plain = random_problem(width, height, seed, 0.1, outside_share);
    GridProblem there = plain;
    plain_sweeps(plain, alpha, sweeps);
    solver::relax_opencl(there, alpha, sweeps, on_device());
    for (std::int64_t i = 0; i < plain.kind.cells(); ++i) {
        RC_ASSERT(same_bits(plain.value[i], there.value[i]));
    }
}

TEST(OpenClRelax, HasTheProcessorsBits) {
    GridProblem const problem = random_problem(230, 90, 4, 0.02, 0.05);
    solver::ExplicitParams const params{.alpha = 0.25, .sweeps = 1501};
    auto const here = solver::relax_explicit(problem, params);
    auto const there = solver::relax_explicit(problem, params, on_device());
    EXPECT_TRUE(same_bits(here.residual, there.residual));
    EXPECT_EQ(here.iterations, there.iterations);
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        ASSERT_TRUE(same_bits(here.value[i], there.value[i])) << i;
    }
}

TEST(OpenClRelax, StopsBetweenSweeps) {
    GridProblem const problem = random_problem(60, 60, 2, 0.1, 0.0);
    std::stop_source stop;
    thalweg::Run run = on_device();
    run.stop = stop.get_token();
    run.progress_arg = &stop;
    run.progress = [](double share, char const*, void* source) {
        if (share > 0.0) {
            static_cast<std::stop_source*>(source)->request_stop();
        }
        return 1;
    };
    EXPECT_THROW(solver::relax_explicit(problem, {.sweeps = 100'000'000}, run), Cancelled);
}

} // namespace opencl_test
