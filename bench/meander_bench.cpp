// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>

#include <benchmark/benchmark.h>

#include <thalweg/flow/catchments.hpp>
#include <thalweg/growth/forest/coast.hpp>
#include <thalweg/growth/forest/grow_forest.hpp>
#include <thalweg/network/planform/meander.hpp>

// Bends of a forest's rivers, and the growth of the forest as the yardstick. One thread. An item is a vertex.
// Arguments: cells a side, distance between rivers [cells].

namespace {

using namespace thalweg;

growth::PlantedForest planted(benchmark::State const& state, Run const& run) {
    Grid grid;
    grid.width = grid.height = state.range(0);
    Mask const land(grid, 1);
    growth::ForestParams params;
    params.step_cells = state.range(1);
    return growth::plant_forest(land, growth::spread_outlets(land, growth::coast_cells(land)), params, run);
}

Run one_thread() {
    Run run;
    run.threads = 1;
    return run;
}

void BM_meander_growth(benchmark::State& state) {
    Run const run = one_thread();
    for ([[maybe_unused]] auto _ : state) {
        auto const forest = planted(state, run);
        benchmark::DoNotOptimize(forest.particles);
    }
}

void BM_meander(benchmark::State& state) {
    Run const run = one_thread();
    Grid grid;
    grid.width = grid.height = state.range(0);
    StreamNetwork const rivers = planted(state, run).network;
    auto const areas = flow::areas_nearest(rivers, grid, run).ds_area_m2;
    std::int64_t vertices = 0;
    for ([[maybe_unused]] auto _ : state) {
        vertices = network::meander(rivers, grid, areas, {}, run).vertices;
    }
    state.counters["vertices"] = static_cast<double>(vertices);
    state.SetItemsProcessed(state.iterations() * vertices);
}

BENCHMARK(BM_meander_growth)->Args({1024, 20})->Args({2048, 20})->Unit(benchmark::kMillisecond);
BENCHMARK(BM_meander)->Args({1024, 20})->Args({2048, 20})->Unit(benchmark::kMillisecond);

} // namespace
