// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>
#include <measure/faults.hpp>
#include <measure/star.hpp>

#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/triangles.hpp>
#include <thalweg/measure/topology/topology.hpp>

// The whole check of a network's topology (goal: 100 000 arcs in a second), the part of it that is geometry, and beside
// that its yardstick: every pair of segments by the same exact predicate.
namespace {

using namespace thalweg;

struct Arcs {
    explicit Arcs(NetworkFile const& file) {
        for (auto const& arc : file.arcs) {
            auto& line = lines.emplace_back();
            for (Vec3 const p : arc.line) {
                line.push_back({p.x, p.y});
            }
            nodes.push_back({static_cast<std::size_t>(arc.from_node), static_cast<std::size_t>(arc.to_node)});
        }
    }
    std::vector<std::vector<Vec2>> lines;
    std::vector<geometry::EndNodes> nodes;
};

void BM_check_topology(benchmark::State& state) {
    NetworkFile const file = faults::clean_of(static_cast<std::size_t>(state.range(0)), 1);
    for (auto _ : state) {
        benchmark::DoNotOptimize(measure::check_topology(file));
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(file.arcs.size()));
}

/// Columns of arcs that end in one node: linear in their number.
void BM_check_columns_star(benchmark::State& state) {
    faults::Star const star(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(star.check_columns());
    }
    state.SetComplexityN(state.range(0));
}

void BM_meetings(benchmark::State& state) {
    Arcs const arcs(faults::clean_of(static_cast<std::size_t>(state.range(0)), 1));
    for (auto _ : state) {
        benchmark::DoNotOptimize(geometry::meetings(arcs.lines, arcs.nodes));
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

void BM_meetings_all_pairs(benchmark::State& state) {
    Arcs const arcs(faults::clean_of(static_cast<std::size_t>(state.range(0)), 1));
    std::vector<std::pair<Vec2, Vec2>> segments;
    for (auto const& line : arcs.lines) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            segments.emplace_back(line[i], line[i + 1]);
        }
    }
    for (auto _ : state) {
        std::int64_t met = 0;
        for (std::size_t i = 0; i < segments.size(); ++i) {
            auto const [a, b] = segments[i];
            for (std::size_t j = i + 1; j < segments.size(); ++j) {
                auto const [c, d] = segments[j];
                met += geometry::side_of_line(a, b, c) * geometry::side_of_line(a, b, d) < 0 &&
                               geometry::side_of_line(c, d, a) * geometry::side_of_line(c, d, b) < 0
                           ? 1
                           : 0;
            }
        }
        benchmark::DoNotOptimize(met);
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(BM_check_topology)->Arg(1000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_check_columns_star)->RangeMultiplier(10)->Range(1000, 100000)->Complexity(benchmark::oN);
BENCHMARK(BM_meetings)->Arg(1000)->Arg(100000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_meetings_all_pairs)->Arg(1000)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
