// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/internal/follow.hpp>

#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/run/parallel.hpp>

namespace thalweg::blend {
namespace {

using solver::fixed_cell;
using solver::free_cell;
using solver::outside_cell;

struct Mean {
    double sum = 0.0;
    double cells = 0.0;
    Mean& operator+=(Mean const& other) {
        sum += other.sum;
        cells += other.cells;
        return *this;
    }
};

// What is sought is the difference from the carrier.
void set_values(solver::GridProblem& problem, Raster<double> const& fixed, Raster<double> const& carrier,
                Run const& run) {
    std::int64_t const width = fixed.width();
    auto const mean = sum_rows(run, fixed.height(), [&](std::int64_t row) {
        Mean of_row;
        for (std::int64_t i = row * width; i < (row + 1) * width; ++i) {
            if (problem.kind[i] == fixed_cell) {
                problem.value[i] = fixed[i] - carrier[i];
                of_row += {problem.value[i], 1.0};
            }
        }
        return of_row;
    });
    double const guess = mean.cells > 0.0 ? mean.sum / mean.cells : 0.0;
    parallel_ranges(run, fixed.cells(), 1 << 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (problem.kind[i] == free_cell) {
                problem.value[i] = guess;
            }
        }
    });
}

void set_source(solver::GridProblem& problem, Raster<double> const& carrier, Guidance const& guidance, Run const& run) {
    problem.source = Raster<double>(carrier.grid());
    std::int64_t const width = carrier.width();
    parallel_ranges(run, carrier.height(), 8, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin * width; i < end * width; ++i) {
            if (problem.kind[i] != free_cell) {
                continue;
            }
            // By how much more than the carrier's own each difference shall be.
            auto const more = [&](Raster<double> const& wanted, std::int64_t here, std::int64_t there) {
                return problem.kind[here] == outside_cell || problem.kind[there] == outside_cell
                           ? 0.0
                           : wanted[here] - (carrier[there] - carrier[here]);
            };
            std::int64_t const col = i % width;
            double const to_east = col + 1 < width ? more(guidance.east, i, i + 1) : 0.0;
            double const from_west = col > 0 ? more(guidance.east, i - 1, i) : 0.0;
            double const to_south = i + width < carrier.cells() ? more(guidance.south, i, i + width) : 0.0;
            double const from_north = i >= width ? more(guidance.south, i - width, i) : 0.0;
            problem.source[i] = (from_west - to_east) + (from_north - to_south);
        }
    });
}

} // namespace

solver::GridSolution follow(Raster<std::uint8_t> const& kind, Raster<double> const& fixed,
                            Raster<double> const& carrier, Guidance const& guidance,
                            solver::PoissonParams const& params, Run const& run) {
    solver::GridProblem problem{kind, Raster<double>(kind.grid()), {}};
    set_values(problem, fixed, carrier, run);
    if (guidance.east.cells() > 0) {
        set_source(problem, carrier, guidance, run);
    }
    solver::GridSolution solution = solver::solve_poisson(std::move(problem), params, run);
    parallel_ranges(run, kind.cells(), 1 << 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (kind[i] == free_cell) {
                solution.value[i] += carrier[i];
            } else if (kind[i] == fixed_cell) {
                solution.value[i] = fixed[i];
            }
        }
    });
    return solution;
}

} // namespace thalweg::blend
