// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>

#include "../tests/network/masks.hpp"
#include "../tests/network/plain_thinning.hpp"

// Thinning beside its yardsticks, items = cells of the grid; allocation counts. Then what follows it.
namespace {

using namespace thalweg;

/// Branches seven cells thick that cover a tenth of the grid.
Mask branches(std::int64_t side) {
    return test::random_blob(7, side, side, static_cast<int>(side / 8), 7);
}

/// The sweeps of test::plain_thin with a table of the 256 neighbourhoods and no bounds to test: how thinning is usually
/// written.
Mask table_thin(Mask const& mask) {
    std::array<std::uint8_t, 256> table{};
    for (unsigned code = 0; code < 256; ++code) {
        std::array<int, 10> p{};
        for (unsigned k = 0; k < 8; ++k) {
            p[k + 2] = static_cast<int>((code >> k) & 1U);
        }
        table[code] =
            static_cast<std::uint8_t>((test::guo_hall_deletes(p, 0) ? 1 : 0) + (test::guo_hall_deletes(p, 1) ? 2 : 0));
    }
    std::int64_t const w = mask.width() + 2;
    std::vector<std::uint8_t> now(static_cast<std::size_t>(w * (mask.height() + 2)), 0);
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        Cell const c = mask.grid().at(i);
        now[static_cast<std::size_t>((c.row + 1) * w + c.col + 1)] = mask[i] != 0 ? 1 : 0;
    }
    std::vector<std::uint8_t> before;
    for (bool changed = true; changed;) {
        changed = false;
        for (unsigned subiteration = 1; subiteration <= 2; ++subiteration) {
            before = now;
            for (std::int64_t row = 1; row <= mask.height(); ++row) {
                std::uint8_t const* const p = before.data() + row * w;
                for (std::int64_t x = 1; x <= mask.width(); ++x) {
                    if (p[x] == 0) {
                        continue;
                    }
                    auto const bit = [&](std::int64_t at, unsigned k) { return static_cast<unsigned>(p[at]) << k; };
                    unsigned const code = bit(x - w, 0) | bit(x - w + 1, 1) | bit(x + 1, 2) | bit(x + w + 1, 3) |
                                          bit(x + w, 4) | bit(x + w - 1, 5) | bit(x - 1, 6) | bit(x - w - 1, 7);
                    if ((table[code] & subiteration) != 0) {
                        now[static_cast<std::size_t>(row * w + x)] = 0;
                        changed = true;
                    }
                }
            }
        }
    }
    Mask out(mask.grid());
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        Cell const c = mask.grid().at(i);
        out[i] = now[static_cast<std::size_t>((c.row + 1) * w + c.col + 1)];
    }
    return out;
}

template <class Thin> void thin_with(benchmark::State& state, Thin thin) {
    Mask const mask = branches(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(thin(mask));
    }
    state.SetItemsProcessed(state.iterations() * mask.cells());
}

void BM_thin_plain(benchmark::State& state) {
    thin_with(state, test::plain_thin);
}
void BM_thin_table(benchmark::State& state) {
    thin_with(state, table_thin);
}
void BM_thin(benchmark::State& state) {
    thin_with(state, [](Mask const& mask) { return network::thin(mask); });
}
BENCHMARK(BM_thin_plain)->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_thin_table)->Arg(1024)->Arg(4096)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_thin)->Arg(1024)->Arg(4096)->Unit(benchmark::kMillisecond);

/// Ragged enough for tens of thousands of arcs.
Mask skeleton_of_burrs(std::int64_t side) {
    return network::thin(test::random_blob(7, side, side, static_cast<int>(side * 2), 1));
}

void BM_trace(benchmark::State& state) {
    Mask const skeleton = skeleton_of_burrs(state.range(0));
    std::size_t arcs = 0;
    for (auto _ : state) {
        arcs = network::trace(skeleton, {Vec2{}}).arc_count();
    }
    std::int64_t cells = 0;
    for (auto const v : skeleton.values()) {
        cells += v;
    }
    state.SetItemsProcessed(state.iterations() * cells);
    state.counters["skeleton_cells"] = static_cast<double>(cells);
    state.counters["arcs"] = static_cast<double>(arcs);
}
BENCHMARK(BM_trace)->Arg(512)->Arg(1024)->Unit(benchmark::kMillisecond);

template <class Stage> void after_tracing(benchmark::State& state, Stage stage) {
    StreamNetwork const network = network::trace(skeleton_of_burrs(state.range(0)), {Vec2{}});
    for (auto _ : state) {
        benchmark::DoNotOptimize(stage(network));
    }
    state.counters["arcs"] = static_cast<double>(network.arc_count());
}

void BM_prune(benchmark::State& state) {
    after_tracing(
        state, [](StreamNetwork const& network) { return network::prune(network, {.length_m = 20.0, .cell_m = 1.0}); });
}
void BM_order(benchmark::State& state) {
    after_tracing(state, [](StreamNetwork const& network) { return network::order(network); });
}
void BM_set_heights(benchmark::State& state) {
    after_tracing(state, [](StreamNetwork const& network) { return network::set_heights(network); });
}
void BM_rasterise(benchmark::State& state) {
    Grid const grid = test::frame(state.range(0), state.range(0));
    auto const raised = network::set_heights(network::trace(skeleton_of_burrs(state.range(0)), {Vec2{}})).network;
    for (auto _ : state) {
        benchmark::DoNotOptimize(network::rasterise(raised, grid));
    }
}
BENCHMARK(BM_prune)->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_order)->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_set_heights)->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_rasterise)->Arg(1024)->Unit(benchmark::kMillisecond);

} // namespace
