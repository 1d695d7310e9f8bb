// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>
#include <growth/plain_forest.hpp>

#include <thalweg/growth/forest/coast.hpp>
#include <thalweg/growth/forest/grow_forest.hpp>

// An item is a cell of the grid, all of it land; growth goes on until it is full. Arguments: cells a side, cells a
// step. The yardstick has the rules written out: unit steps, and every question asked of all particles.

namespace {

thalweg::Grid square(std::int64_t side) {
    thalweg::Grid grid;
    grid.width = side;
    grid.height = side;
    return grid;
}

void BM_plant_forest_unit_steps(benchmark::State& state) {
    thalweg::Mask const land(square(state.range(0)), 1);
    thalweg::growth::ForestParams params;
    params.step_cells = state.range(1);
    for ([[maybe_unused]] auto _ : state) {
        auto const forest = plain_forest::grow(land, {{0, 0}}, params);
        benchmark::DoNotOptimize(forest.cells.data());
    }
    state.SetItemsProcessed(state.iterations() * land.cells());
}

void BM_plant_forest(benchmark::State& state) {
    thalweg::Mask const land(square(state.range(0)), 1);
    auto const outlets = thalweg::growth::spread_outlets(land, thalweg::growth::coast_cells(land));
    thalweg::growth::ForestParams params;
    params.step_cells = state.range(1);
    for ([[maybe_unused]] auto _ : state) {
        auto const planted = thalweg::growth::plant_forest(land, outlets, params);
        benchmark::DoNotOptimize(planted.particles);
    }
    state.SetItemsProcessed(state.iterations() * land.cells());
}

void BM_shape_island(benchmark::State& state) {
    for ([[maybe_unused]] auto _ : state) {
        auto const land = thalweg::growth::shape_island(square(state.range(0)));
        benchmark::DoNotOptimize(land.values().data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(0));
}

} // namespace

BENCHMARK(BM_plant_forest_unit_steps)->Args({40, 5})->Unit(benchmark::kMillisecond);
BENCHMARK(BM_plant_forest)
    ->Args({40, 5})
    ->Args({512, 5})
    ->Args({1024, 5})
    ->Args({2048, 5})
    ->Args({2048, 10})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(BM_shape_island)->Arg(1024)->Unit(benchmark::kMillisecond);
