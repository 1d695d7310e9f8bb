// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <benchmark/benchmark.h>

// The yardstick of memory: a float grid copied to warm memory; an item is a cell.
static void BM_memcpy(benchmark::State& state) {
    auto const cells = static_cast<std::size_t>(state.range(0) * state.range(0));
    std::vector<float> const from(cells, 1.0F);
    std::vector<float> to(cells, 0.0F);
    for ([[maybe_unused]] auto _ : state) {
        std::memcpy(to.data(), from.data(), cells * sizeof(float));
        benchmark::DoNotOptimize(to.data());
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(cells));
}
BENCHMARK(BM_memcpy)->Arg(1024)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);
