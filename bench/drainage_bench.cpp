// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/condition.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/measure/drainage/certificate.hpp>
#include <thalweg/measure/relief/statistics.hpp>

#include "inputs.hpp"

namespace {

using namespace thalweg;

using inputs::relief;

void set_cells(benchmark::State& state) {
    state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(0));
}

void BM_route_relief(benchmark::State& state) {
    Raster<float> const dem = relief(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(flow::route(dem));
    }
    set_cells(state);
}
BENCHMARK(BM_route_relief)->Arg(1024)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);

/// The same relief, made to drain.
Raster<float> drained_relief(std::int64_t side) {
    Raster<float> const dem = relief(side);
    Valley const none{Raster<float>(dem.grid(), std::numeric_limits<float>::quiet_NaN())};
    return flow::condition(dem, none, {flow::Conditioning::fill}).dem;
}

Run one_thread() {
    Run run;
    run.threads = 1;
    return run;
}

void BM_route_drained(benchmark::State& state) {
    Raster<float> const dem = drained_relief(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(flow::route(dem, one_thread()));
    }
    set_cells(state);
}
BENCHMARK(BM_route_drained)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond);

/// The yardstick of BM_route_drained: steepest descent in float inside the border, and areas by counts of donors.
void BM_plain_d8(benchmark::State& state) {
    Raster<float> const dem = drained_relief(state.range(0));
    auto const offsets = d8_offsets(dem.grid());
    for (auto _ : state) {
        Raster<std::int8_t> way(dem.grid(), -1);
        Raster<std::int64_t> area(dem.grid(), 1);
        Raster<std::uint8_t> donors(dem.grid());
        for (std::int64_t r = 1; r + 1 < dem.height(); ++r) {
            for (std::int64_t i = r * dem.width() + 1; i + 1 < (r + 1) * dem.width(); ++i) {
                float steepest = 0.0F;
                for (std::size_t k = 0; k < offsets.size(); ++k) {
                    float const slope = (dem[i] - dem[i + offsets[k]]) * static_cast<float>(d8_per_length[k]);
                    if (slope > steepest) {
                        steepest = slope;
                        way[i] = static_cast<std::int8_t>(k);
                    }
                }
                if (way[i] >= 0) {
                    ++donors[i + offsets[static_cast<std::size_t>(way[i])]];
                }
            }
        }
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            for (std::int64_t at = i; donors[at] == 0 && way[at] >= 0;) {
                std::int64_t const next = at + offsets[static_cast<std::size_t>(way[at])];
                area[next] += area[at];
                way[at] = -1;
                --donors[next];
                at = next;
            }
        }
        benchmark::DoNotOptimize(area.values().data());
    }
    set_cells(state);
}
BENCHMARK(BM_plain_d8)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond);

void BM_route_dinf(benchmark::State& state) {
    Raster<float> const dem = relief(state.range(0));
    flow::FlowField const d8 = flow::route(dem);
    for (auto _ : state) {
        benchmark::DoNotOptimize(flow::route_dinf(dem, d8));
    }
    set_cells(state);
}
BENCHMARK(BM_route_dinf)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond);

void BM_route_noise(benchmark::State& state) {
    Raster<float> dem(Grid{state.range(0), state.range(0), 1.0, 0.0, 0.0, ""});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = static_cast<float>(unit(random_word(1, static_cast<std::uint64_t>(i))));
    }
    for (auto _ : state) {
        benchmark::DoNotOptimize(flow::route(dem));
    }
    set_cells(state);
}
BENCHMARK(BM_route_noise)->Arg(1024)->Arg(4096)->Unit(benchmark::kMillisecond);

void BM_statistics_relief(benchmark::State& state) {
    Raster<float> const dem = relief(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(measure::statistics(dem));
    }
    set_cells(state);
}
BENCHMARK(BM_statistics_relief)->Arg(4096)->Unit(benchmark::kMillisecond);

/// Against BM_route_relief: what making a land drain costs beside measuring it.
void BM_condition_relief(benchmark::State& state) {
    Raster<float> const dem = relief(state.range(0));
    Valley const none{Raster<float>(dem.grid(), std::numeric_limits<float>::quiet_NaN())};
    auto const method = state.range(1) == 0 ? flow::Conditioning::fill : flow::Conditioning::carve;
    for (auto _ : state) {
        flow::ConditionedDem const land = flow::condition(dem, none, {method});
        state.counters["volume_m3"] = land.depressions.volume_m3();
    }
    set_cells(state);
}
BENCHMARK(BM_condition_relief)
    ->ArgsProduct({{1024, 2048, 4096}, {0, 1}})
    ->ArgNames({"side", "carve"})
    ->Unit(benchmark::kMillisecond);

/// White noise: depressions everywhere.
void BM_condition_noise(benchmark::State& state) {
    Raster<float> dem(Grid{state.range(0), state.range(0), 1.0, 0.0, 0.0, ""});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = static_cast<float>(unit(random_word(1, static_cast<std::uint64_t>(i))));
    }
    Valley const none{Raster<float>(dem.grid(), std::numeric_limits<float>::quiet_NaN())};
    auto const method = state.range(1) == 0 ? flow::Conditioning::fill : flow::Conditioning::carve;
    for (auto _ : state) {
        benchmark::DoNotOptimize(flow::condition(dem, none, {method}, one_thread()));
    }
    set_cells(state);
}
BENCHMARK(BM_condition_noise)
    ->ArgsProduct({{1024, 2048}, {0, 1}})
    ->ArgNames({"side", "carve"})
    ->Unit(benchmark::kMillisecond);

/// Terrain that drains, without rivers and with those of 1000 cells, handed over as a recipe does; against BM_memcpy.
void BM_condition_drained(benchmark::State& state) {
    Raster<float> dem = drained_relief(state.range(0));
    Valley valley{Raster<float>(dem.grid(), std::numeric_limits<float>::quiet_NaN())};
    if (state.range(1) != 0) {
        flow::FlowField const drainage = flow::route(dem);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            valley.z[i] = drainage.area_cells[i] >= 1000 ? dem[i] : valley.z[i];
        }
        dem = flow::condition(std::move(dem), valley).dem;
    }
    for (auto _ : state) {
        dem = flow::condition(std::move(dem), valley, {}, one_thread()).dem;
    }
    set_cells(state);
}
BENCHMARK(BM_condition_drained)
    ->ArgsProduct({{1024, 2048}, {0, 1}})
    ->ArgNames({"side", "rivers"})
    ->Unit(benchmark::kMillisecond);

/// The streams of a DEM by area, a reach from each head or confluence to the next.
flow::Reaches streams(flow::FlowField const& drainage, std::int64_t area) {
    Grid const& grid = drainage.direction.grid();
    auto const next = [&](std::int64_t i) { return drainage.receiver(i); };
    Raster<std::uint8_t> arriving(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (drainage.area_cells[i] >= area && next(i) >= 0) {
            ++arriving[next(i)];
        }
    }
    flow::Reaches reaches;
    Raster<std::int64_t> begins(grid, -1);
    std::vector<std::int64_t> ends;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (drainage.area_cells[i] >= area && arriving[i] != 1 && next(i) >= 0) {
            begins[i] = static_cast<std::int64_t>(reaches.size());
            std::vector<Vec2> line{grid.centre(grid.at(i))};
            std::int64_t at = i;
            do {
                at = next(at);
                line.push_back(grid.centre(grid.at(at)));
            } while (arriving[at] == 1 && next(at) >= 0);
            reaches.push_back({{line}, -1, begins[i] + 1});
            ends.push_back(at);
        }
    }
    for (std::size_t r = 0; r < reaches.size(); ++r) {
        reaches[r].ds = begins[ends[r]];
    }
    return reaches;
}

/// The whole certificate: the DEM's drainage and what the network's say of it.
void BM_certify(benchmark::State& state) {
    Raster<float> const dem = relief(state.range(0));
    flow::Reaches const reaches = streams(flow::route(dem), 1000);
    for (auto _ : state) {
        flow::FlowField const drainage = flow::route(dem);
        benchmark::DoNotOptimize(measure::certify(dem, drainage, reaches));
    }
    state.counters["arcs"] = static_cast<double>(reaches.size());
    state.SetItemsProcessed(state.iterations() * dem.cells());
}
BENCHMARK(BM_certify)->Arg(2048)->Unit(benchmark::kMillisecond);

/// A hundred parallel rivers from north to south.
void BM_areas_nearest(benchmark::State& state) {
    Grid const grid{state.range(0), state.range(0), 1.0, 0.0, static_cast<double>(state.range(0)), ""};
    NetworkDraft drawn;
    for (std::int64_t k = 0; k < 100; ++k) {
        std::int64_t const col = k * grid.width / 100;
        auto const north = drawn.add_node(grid.centre({col, 0}));
        auto const south = drawn.add_node(grid.centre({col, grid.height - 1}));
        drawn.add_arc(north, south);
    }
    StreamNetwork const rivers(std::move(drawn));
    for (auto _ : state) {
        benchmark::DoNotOptimize(flow::areas_nearest(rivers, grid));
    }
    set_cells(state);
}
BENCHMARK(BM_areas_nearest)->Arg(4096)->Unit(benchmark::kMillisecond);

} // namespace
