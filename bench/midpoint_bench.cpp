// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Midpoint displacement beside memcpy of its result, so that ratios of ns_per_cell (processor time of all threads) are
// read from one run. BM_midpoint_reused/STENCIL/NOISE/threads: 33 x 33 coarse cells to 8192 x 8192, into a DEM and
// lattices that have been touched before. BM_midpoint: the whole stage, with the memory it allocates, first touch
// included. One and two threads.
#include <cstring>

#include <benchmark/benchmark.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/fractal/internal/refine.hpp>
#include <thalweg/fractal/midpoint.hpp>

namespace {

using namespace thalweg;
using namespace thalweg::fractal;

constexpr std::int64_t side = 8192;

Raster<float> const& coarse_land() {
    static Raster<float> const land = [] {
        Raster<float> z(Grid{33, 33, 256.0, 0.0, 0.0, ""});
        for (std::int64_t i = 0; i < z.cells(); ++i) {
            z[i] = static_cast<float>(1000.0 * unit(random_word(3, static_cast<std::uint64_t>(i))));
        }
        return z;
    }();
    return land;
}

void count(benchmark::State& state) {
    std::int64_t const cells = state.iterations() * side * side;
    state.SetItemsProcessed(cells);
    state.counters["ns_per_cell"] = benchmark::Counter(static_cast<double>(cells) * 1e-9,
                                                       benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

Run on(std::int64_t threads) {
    Run run;
    run.threads = static_cast<int>(threads);
    return run;
}

void BM_midpoint_memcpy(benchmark::State& state) {
    Raster<float> const from(Grid{side, side, 1.0, 0.0, 0.0, ""}, 1.0F);
    Raster<float> to(from.grid());
    for (auto _ : state) {
        parallel_ranges(on(state.range(0)), side, side / state.range(0), [&](std::int64_t first, std::int64_t last) {
            std::memcpy(to.row(first).data(), from.row(first).data(),
                        static_cast<std::size_t>((last - first) * side) * sizeof(float));
        });
        benchmark::ClobberMemory();
    }
    count(state);
}

void BM_midpoint_reused(benchmark::State& state, Stencil stencil, Noise noise, Lanes lanes) {
    Refinement refinement;
    refinement.coarse = &coarse_land();
    refinement.levels = 8;
    refinement.stencil = stencil;
    refinement.noise = noise;
    refinement.character.sigma = 300.0;
    refinement.lanes = lanes;
    Raster<float> dem(Grid{side, side, 1.0, 0.0, 0.0, ""});
    Floors floors;
    refine(refinement, dem, floors, on(2)); // takes the memory
    for (auto _ : state) {
        refine(refinement, dem, floors, on(state.range(0)));
        benchmark::ClobberMemory();
    }
    count(state);
}

void BM_midpoint(benchmark::State& state) {
    MidpointParams params;
    params.levels = 8;
    params.width = side;
    params.height = side;
    for (auto _ : state) {
        benchmark::DoNotOptimize(midpoint(coarse_land(), params, on(state.range(0))));
    }
    count(state);
}

#define THREADS Arg(1)->Arg(2)->ArgName("threads")->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond)
BENCHMARK(BM_midpoint_memcpy)->THREADS;
BENCHMARK_CAPTURE(BM_midpoint_reused, 4_uniform, Stencil::four, Noise::uniform, widest_lanes())->THREADS;
BENCHMARK_CAPTURE(BM_midpoint_reused, 4_normal, Stencil::four, Noise::normal, widest_lanes())->THREADS;
BENCHMARK_CAPTURE(BM_midpoint_reused, 16_uniform, Stencil::sixteen, Noise::uniform, widest_lanes())->THREADS;
BENCHMARK_CAPTURE(BM_midpoint_reused, 16_normal, Stencil::sixteen, Noise::normal, widest_lanes())->THREADS;
BENCHMARK_CAPTURE(BM_midpoint_reused, 16_normal_plain, Stencil::sixteen, Noise::normal, Lanes::plain)->THREADS;
BENCHMARK(BM_midpoint)->THREADS;
#undef THREADS

} // namespace
