// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Poisson blending beside Laplace's equation of equal size on the same solver, so that their ratio is read from one
// run. One thread. Half of the grid is the mask: the middle square with half of the cells.
// BM_blend_laplace: solve_poisson with the mask's cells free and all others fixed, with the memory it allocates.
// BM_blend_paste: the whole stage, opening and target's copy included. BM_blend_paste_feathered: the same with a
// guidance field.
#include <cmath>

#include <benchmark/benchmark.h>

#include <thalweg/blend/paste.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace {

using namespace thalweg;

struct Lands {
    Raster<float> target;
    blend::Patch patch;
};

float height(std::uint64_t seed, Cell c) {
    auto const x = static_cast<double>(c.col);
    auto const y = static_cast<double>(c.row);
    return static_cast<float>(
        400.0 + 120.0 * std::sin(0.013 * x + static_cast<double>(seed)) * std::cos(0.017 * y) +
        3.0 * unit(random_word(seed, static_cast<std::uint64_t>(c.col), static_cast<std::uint64_t>(c.row))));
}

Lands const& lands_of(std::int64_t side) {
    static Lands lands;
    if (lands.target.width() != side) {
        Grid const grid{side, side, 30.0, 0.0, 0.0, ""};
        lands = {Raster<float>(grid), {Mask(grid), Raster<double>(grid)}};
        auto const margin = static_cast<std::int64_t>(0.5 * (1.0 - std::sqrt(0.5)) * static_cast<double>(side));
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            Cell const c = grid.at(i);
            lands.target[i] = height(1, c);
            lands.patch.z[i] = height(2, c);
            lands.patch.mask[i] = c.col >= margin && c.row >= margin && c.col < side - margin && c.row < side - margin;
        }
    }
    return lands;
}

Run one_thread() {
    Run run;
    run.threads = 1;
    return run;
}

void BM_blend_laplace(benchmark::State& state) {
    Lands const& lands = lands_of(state.range(0));
    Grid const& grid = lands.target.grid();
    for (auto _ : state) {
        solver::GridProblem problem{Raster<std::uint8_t>(grid), Raster<double>(grid), {}};
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            problem.kind[i] =
                static_cast<std::uint8_t>(lands.patch.mask[i] != 0 ? solver::CellKind::free : solver::CellKind::fixed);
            problem.value[i] = lands.patch.mask[i] != 0 ? 400.0 : static_cast<double>(lands.target[i]);
        }
        benchmark::DoNotOptimize(solver::solve_poisson(std::move(problem), {}, one_thread()));
    }
}

void BM_blend_paste(benchmark::State& state) {
    Lands const& lands = lands_of(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(blend::paste(lands.target, lands.patch, {}, one_thread()));
    }
}

void BM_blend_paste_feathered(benchmark::State& state) {
    Lands const& lands = lands_of(state.range(0));
    blend::PasteParams params;
    params.feather_cells = 16.0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(blend::paste(lands.target, lands.patch, params, one_thread()));
    }
}

BENCHMARK(BM_blend_laplace)->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_blend_paste)->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_blend_paste_feathered)->Arg(1024)->Unit(benchmark::kMillisecond);

} // namespace
