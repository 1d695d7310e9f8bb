// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <fstream>
#include <string_view>
#include <unistd.h>

#include <benchmark/benchmark.h>

#include <thalweg/core/run/memory.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

#include "../tests/support.hpp"
#include "../tests/surface/channel_trees.hpp"

namespace {

using namespace thalweg;

/// A tree at random from the middle of the southern border, a hundredth of the cells.
Channels rivers(std::int64_t side) {
    Grid const grid = test::frame(side, side, 30.0);
    return channel_trees::grown(grid, {grid.index({side / 2, side - 1})}, {}, grid.cells() / 100,
                                channel_trees::Room::apart, 1);
}

/// Memory [bytes] this process holds.
std::int64_t held_bytes() {
    std::int64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages >> pages;
    return pages * sysconf(_SC_PAGESIZE);
}

/// Counts rounds, which the solver reports as "fill", by their cells: each coarser level ends at a quarter of the
/// progress of the next finer one, and has a quarter of its cells.
int count_round(double done, char const* what, void* rounds) {
    double cells = 1.0;
    for (; done > 0.0 && done < 0.25 * cells; cells *= 0.25) {
    }
    *static_cast<double*>(rounds) += std::string_view(what) == "fill" ? cells : 0.0;
    return 1;
}

/// On one core; bytes_per_cell: what the process has held at most less what it held before, the rivers among it, where
/// no benchmark before it held more; rounds: of all cells, those on coarser levels by their share.
void BM_equilibrium(benchmark::State& state) {
    Channels const channels = rivers(state.range(0));
    surface::EquilibriumParams params;
    params.roughness = state.range(1) == 0 ? 0.0 : params.roughness;
    Run run;
    run.threads = 1;
    double rounds = 0.0;
    run.progress = count_round;
    run.progress_arg = &rounds;
    std::int64_t const before = held_bytes();
    std::int64_t const peak = peak_memory_bytes();
    for (auto _ : state) {
        benchmark::DoNotOptimize(surface::equilibrium(channels, {}, params, run));
    }
    if (peak_memory_bytes() > peak) {
        state.counters["bytes_per_cell"] =
            static_cast<double>(peak_memory_bytes() - before) / static_cast<double>(channels.grid.cells());
    }
    state.counters["rounds"] = rounds / static_cast<double>(state.iterations());
    state.SetItemsProcessed(state.iterations() * channels.grid.cells());
}
BENCHMARK(BM_equilibrium)
    ->Args({512, 1})
    ->Args({1024, 1})
    ->Args({2048, 1})
    ->Args({4096, 1})
    ->Args({8192, 1})
    ->Args({1024, 0})
    ->ArgNames({"side", "rough"})
    ->Unit(benchmark::kMillisecond);

/// The yardstick: what finding the ways of water on the finished land costs.
void BM_route_equilibrium(benchmark::State& state) {
    Run run;
    run.threads = 1;
    Raster<float> const dem = surface::equilibrium(rivers(state.range(0)), {}, {}, run).dem;
    for (auto _ : state) {
        benchmark::DoNotOptimize(flow::route(dem, run));
    }
    state.SetItemsProcessed(state.iterations() * dem.cells());
}
BENCHMARK(BM_route_equilibrium)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond);

} // namespace
