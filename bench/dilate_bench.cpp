// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Dilation beside memcpy of its float grid, so that ratios of ns_per_cell are read from one run. One thread.
// BM_dilate_closed and BM_dilate_frontier: the whole stage, with the memory it allocates, first touch included.
// BM_dilate_closed_reused: the same sweeps into a DEM that has been touched before; the levels are still allocated.
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <benchmark/benchmark.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/surface/dilation/dilation.hpp>
#include <thalweg/surface/dilation/separable.hpp>

namespace {

using namespace thalweg;

/// Winding rivers through about 3.5 % of the cells.
Valley rivers(std::int64_t side) {
    Valley valley{Raster<float>(Grid{side, side, 1.0, 0.0, 0.0, ""}, std::numeric_limits<float>::quiet_NaN())};
    RandomStream random(7, 1, 0);
    std::int64_t wanted = side * side * 35 / 1000;
    while (wanted > 0) {
        double x = random.real() * static_cast<double>(side);
        double y = random.real() * static_cast<double>(side);
        double bearing = 6.28 * random.real();
        auto const length = static_cast<std::int64_t>(200.0 + random.real() * static_cast<double>(side) / 4.0);
        for (std::int64_t i = 0; i < length; ++i) {
            x += std::cos(bearing);
            y += std::sin(bearing);
            bearing += 0.6 * (random.real() - 0.5);
            Cell const cell{static_cast<std::int64_t>(std::floor(x)), static_cast<std::int64_t>(std::floor(y))};
            if (!valley.z.grid().contains(cell)) {
                break;
            }
            wanted -= std::isnan(valley.z[cell]) ? 1 : 0;
            valley.z[cell] = static_cast<float>(500.0 + 0.02 * (x + y) + 0.05 * static_cast<double>(i));
        }
    }
    return valley;
}

Valley const& rivers_of(std::int64_t side) {
    static Valley valley;
    if (valley.z.width() != side) {
        valley = rivers(side);
    }
    return valley;
}

void count(benchmark::State& state, std::int64_t side) {
    std::int64_t const cells = state.iterations() * side * side;
    state.SetItemsProcessed(cells);
    state.counters["ns_per_cell"] = benchmark::Counter(static_cast<double>(cells) * 1e-9,
                                                       benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

Run one_thread() {
    Run run;
    run.threads = 1;
    return run;
}

void BM_dilate_memcpy(benchmark::State& state) {
    std::int64_t const side = state.range(0);
    Valley const& valley = rivers_of(side);
    Raster<float> copy(valley.z.grid());
    for (auto _ : state) {
        std::memcpy(copy.values().data(), valley.z.values().data(), copy.values().size_bytes());
        benchmark::ClobberMemory();
    }
    count(state, side);
}

void BM_dilate_frontier(benchmark::State& state) {
    Valley const& valley = rivers_of(state.range(0));
    Mask const inside(valley.z.grid(), 1);
    for (auto _ : state) {
        benchmark::DoNotOptimize(surface::expand_frontier(valley, inside, one_thread()));
    }
    count(state, state.range(0));
}

void BM_dilate_closed(benchmark::State& state) {
    Valley const& valley = rivers_of(state.range(0));
    surface::DilateParams const params{{"uniform"}, surface::Metric::cityblock, 300.0};
    for (auto _ : state) {
        benchmark::DoNotOptimize(surface::dilate(valley, params, one_thread()));
    }
    count(state, state.range(0));
}

void closed_reused(benchmark::State& state, Lanes lanes) {
    Valley const& valley = rivers_of(state.range(0));
    Raster<float> dem(valley.z.grid());
    Run const run = one_thread();
    for (auto _ : state) {
        auto const swept = surface::separable::sweep_down<std::uint16_t>(valley, dem, lanes, run);
        auto const sums = surface::heights_above_valley(surface::increments(swept.levels, {"uniform"}));
        surface::separable::sweep_up(swept, dem, sums, lanes, run);
        benchmark::ClobberMemory();
    }
    count(state, state.range(0));
}

void BM_dilate_closed_reused(benchmark::State& state) {
    closed_reused(state, widest_lanes());
}
void BM_dilate_closed_reused_plain(benchmark::State& state) {
    closed_reused(state, Lanes::plain);
}

#define SIDES Arg(1024)->Arg(4096)->Unit(benchmark::kMillisecond)
BENCHMARK(BM_dilate_memcpy)->Arg(1024)->Arg(4096)->Arg(8192)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_dilate_frontier)->SIDES;
BENCHMARK(BM_dilate_closed)->SIDES->Arg(8192);
BENCHMARK(BM_dilate_closed_reused)->SIDES->Arg(8192);
BENCHMARK(BM_dilate_closed_reused_plain)->SIDES->Arg(8192);
#undef SIDES

} // namespace
