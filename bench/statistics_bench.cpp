// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lands from numbers: the transform, the random field, the statistics and the projection, on every core.
// Arguments are sides of square grids but for BM_match_statistics_table_4, the land of table 4 of paper 001.
#include <benchmark/benchmark.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/skeleton/random_fields.hpp>
#include <thalweg/solver/spectral/fft.hpp>

namespace {

using namespace thalweg;

Grid square(std::int64_t side) {
    return {side, side, 30.0, 0.0, 0.0, ""};
}

/// A cheap rough land: no field is drawn that is larger than what is measured.
Raster<float> land(std::int64_t side) {
    return skeleton::grf(square(side),
                         {.mean = 1000.0, .std = 200.0, .covariance = {60.0, 90.0, 2.3}, .seed = 1, .embedding = 1})
        .dem;
}

void count(benchmark::State& state, std::int64_t cells) {
    state.SetItemsProcessed(state.iterations() * cells);
}

void BM_fft(benchmark::State& state) {
    std::int64_t const side = state.range(0);
    Raster<solver::Complex> values(square(side));
    for (std::int64_t i = 0; i < values.cells(); ++i) {
        values[i] = {unit(random_word(1, static_cast<std::uint64_t>(i))), 0.0};
    }
    for (auto _ : state) {
        values = solver::fft(std::move(values), solver::Direction::forward);
        for (solver::Complex& value : values.values()) {
            value /= static_cast<double>(side);
        }
    }
    count(state, side * side);
}

void BM_grf(benchmark::State& state) {
    for (auto _ : state) {
        benchmark::DoNotOptimize(skeleton::grf(square(state.range(0)), {.covariance = {60.0, 90.0, 2.3}}));
    }
    count(state, state.range(0) * state.range(0));
}

void BM_statistics(benchmark::State& state) {
    Raster<float> const dem = land(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(measure::statistics(dem));
    }
    count(state, dem.cells());
}

void BM_match_statistics(benchmark::State& state) {
    std::int64_t const side = state.range(0);
    Raster<float> const dem = land(side);
    fractal::Targets targets;
    targets.mean = 1000.0;
    targets.std = 180.0;
    targets.max = fractal::FixedHeight{{side / 3, side / 4}, 1900.0};
    targets.min = fractal::FixedHeight{{side - 1, side / 2}, 300.0};
    targets.lx_cells = 60.0;
    targets.ly_cells = 90.0;
    targets.slope_rad = 1.45;
    targets.dimension = 2.3;
    int iterations = 0;
    for (auto _ : state) {
        iterations = fractal::match_statistics(dem, targets, {}, {.prior = {60.0, 90.0, 2.3}}).iterations;
    }
    state.counters["steps"] = iterations;
    count(state, dem.cells());
}

void BM_match_statistics_table_4(benchmark::State& state) {
    fractal::Targets targets;
    targets.mean = 536.0;
    targets.std = 131.6;
    targets.max = fractal::FixedHeight{{91, 1}, 1038.0};
    targets.min = fractal::FixedHeight{{129, 26}, 276.0};
    targets.lx_cells = 20.68;
    targets.ly_cells = 39.74;
    targets.slope_rad = 1.499;
    targets.dimension = 2.39;
    solver::StableCovariance const prior{20.68, 39.74, 2.39};
    for (auto _ : state) {
        auto const dem =
            skeleton::grf({130, 40, 300.0, 0.0, 0.0, ""}, {.mean = 536.0, .std = 131.6, .covariance = prior}).dem;
        benchmark::DoNotOptimize(fractal::match_statistics(dem, targets, {}, {.prior = prior}));
    }
    count(state, 130 * 40);
}

BENCHMARK(BM_fft)->Arg(512)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_grf)->Arg(256)->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_statistics)->Arg(512)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_match_statistics)->Arg(256)->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_match_statistics_table_4)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
