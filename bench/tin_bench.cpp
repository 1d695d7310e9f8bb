// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>
#include <tins.hpp>

#include <thalweg/geometry/tin_of_dem.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

#include "inputs.hpp"

// Triangulation, and beside it the raster of 4096² cells of the same TIN: goal 0.3 of its time. Allocation counts.
// BM_tin_of_dem/ERROR: 2048² cells of 10 m, one thread.
namespace {

using namespace thalweg;

void BM_triangulate(benchmark::State& state) {
    auto const points = test::random_points(static_cast<std::size_t>(state.range(0)), 4096.0, 5);
    for (auto _ : state) {
        benchmark::DoNotOptimize(geometry::triangulate(points));
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

void BM_rasterise_tin(benchmark::State& state) {
    Tin const tin = geometry::triangulate(test::random_points(static_cast<std::size_t>(state.range(0)), 4096.0, 5)).tin;
    Grid const grid{4096, 4096, 1.0, 0.0, 4096.0, ""};
    Run run;
    run.threads = static_cast<int>(state.range(1));
    for (auto _ : state) {
        benchmark::DoNotOptimize(surface::rasterise_tin(tin, grid, {}, run));
    }
    state.SetItemsProcessed(state.iterations() * grid.cells());
}

Raster<float> const& mountains() {
    static Raster<float> const dem = inputs::mountains(6);
    return dem;
}

void BM_tin_of_dem(benchmark::State& state) {
    geometry::TinOfDemParams const params{static_cast<double>(state.range(0))};
    Run run;
    run.threads = 1;
    for (auto _ : state) {
        benchmark::DoNotOptimize(geometry::tin_of_dem(mountains(), params, run));
    }
    state.SetItemsProcessed(state.iterations() * mountains().cells());
}

BENCHMARK(BM_triangulate)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_rasterise_tin)->Args({1000000, 1})->Args({1000000, 2})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_tin_of_dem)->Arg(5)->Arg(1)->Unit(benchmark::kMillisecond);

} // namespace
