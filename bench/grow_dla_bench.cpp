// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>

#include <benchmark/benchmark.h>
#include <growth/unit_step_dla.hpp>

#include <thalweg/growth/dla/grow_dla.hpp>

// An item is a particle; memory and tables made by the growth count. Arguments: particles, 100 S, M. The yardstick has
// the same launch circle, return from afar and occupancy test; only its steps are unit steps.

namespace {

thalweg::growth::DlaParams params_of(benchmark::State const& state) {
    thalweg::growth::DlaParams params;
    params.particles = state.range(0);
    params.sticking = static_cast<double>(state.range(1)) / 100.0;
    params.visits = static_cast<int>(state.range(2));
    return params;
}

template <class Grow> void measure(benchmark::State& state, Grow grow) {
    auto const params = params_of(state);
    for ([[maybe_unused]] auto _ : state) {
        auto const cluster = grow(params);
        benchmark::DoNotOptimize(cluster.cells.data());
    }
    state.SetItemsProcessed(state.iterations() * params.particles);
}

void BM_grow_dla_unit_steps(benchmark::State& state) {
    measure(state, unit_step::grow);
}

void BM_grow_dla(benchmark::State& state) {
    measure(state, [](thalweg::growth::DlaParams const& params) { return thalweg::growth::grow_dla(params); });
}

} // namespace

BENCHMARK(BM_grow_dla_unit_steps)->Args({10000, 100, 1})->Args({10000, 85, 3})->Unit(benchmark::kMillisecond);
BENCHMARK(BM_grow_dla)
    ->Args({10000, 100, 1})
    ->Args({10000, 85, 3})
    ->Args({100000, 100, 1})
    ->Args({100000, 85, 3})
    ->Args({1000000, 100, 1})
    ->Unit(benchmark::kMillisecond);
