// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/choose_lakes.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <queue>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/network/channels/internal/lake_basins.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t lake_stage = 0x6c616b65; // "lake"
constexpr std::int64_t fewest_lake_cells = 16;
constexpr std::int64_t lakes_apart = 3; // [cells]

void check(ChannelsOfArcs const& drawn, std::vector<double> const& area_m2, ChooseLakesParams const& params) {
    require_in("network.choose_lakes", "share", params.share, Range::between(0.0, 1.0));
    if (!(params.min_area_cells >= 0.0) || params.max_cells < 4) {
        throw BadParameter(fmt::format("network.choose_lakes: min_area_cells is {} and max_cells {}; they must be at "
                                       "least 0 and 4",
                                       params.min_area_cells, params.max_cells));
    }
    if (area_m2.size() != drawn.of_arc.size()) {
        throw BadInput(fmt::format("network.choose_lakes: {} areas for {} arcs; give those of this network",
                                   area_m2.size(), drawn.of_arc.size()));
    }
}

class Shores {
public:
    Shores(ChannelsOfArcs const& drawn, std::uint64_t seed)
        : labels(drawn.channels.grid, 0), drawn_(drawn), seed_(seed), is_taken_(drawn.channels.grid, 0) {}

    Raster<std::int32_t> labels;

    /// Grows a lake around a place of an arc; nothing where others are.
    void grow(std::size_t arc, std::int64_t cells, double along) {
        Grid const& grid = labels.grid();
        auto const& way = drawn_.of_arc[arc];
        auto const at = static_cast<std::size_t>(along * static_cast<double>(way.size()));
        std::int64_t const first = drawn_.channels.cell[way[at]];
        std::unordered_set<std::int64_t> river; // looked up only, never walked
        for (std::int64_t const i : way) {
            river.insert(drawn_.channels.cell[i]);
        }
        std::uint64_t const own_seed = random_word(seed_, lake_stage, arc);
        double const wave = std::max(3.0, 0.6 * std::sqrt(static_cast<double>(cells)));
        using Entry = std::pair<double, std::int64_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        std::unordered_set<std::int64_t> done; // looked up only, never walked
        std::vector<std::int64_t> lake;
        queue.emplace(0.0, first);
        while (!queue.empty() && static_cast<std::int64_t>(lake.size()) < cells) {
            auto const [cost, cell] = queue.top();
            queue.pop();
            if (!is_free(cell) || !done.insert(cell).second) {
                continue;
            }
            lake.push_back(cell);
            for (std::size_t k = 0; k < d8_steps.size(); ++k) {
                Cell const c = grid.at(cell);
                Cell const n{c.col + d8_steps[k].col, c.row + d8_steps[k].row};
                if (!grid.contains(n) || done.contains(grid.index(n))) {
                    continue;
                }
                double const rough = 0.5 + 0.5 * value_noise(own_seed, n, wave);
                double const ease = river.contains(grid.index(n)) ? 0.2 : 1.0;
                queue.emplace(cost + ease * (0.15 + rough * rough) / d8_per_length[k], grid.index(n));
            }
        }
        if (static_cast<std::int64_t>(lake.size()) >= fewest_lake_cells) {
            take(rounded(lake));
        }
    }

private:
    bool is_free(std::int64_t cell) const {
        Grid const& grid = labels.grid();
        Cell const c = grid.at(cell);
        return is_taken_[cell] == 0 && c.col >= lakes_apart && c.row >= lakes_apart &&
               c.col < grid.width - lakes_apart && c.row < grid.height - lakes_apart;
    }

    /// Its shores without single cells: what most of its neighbours are.
    std::vector<std::int64_t> rounded(std::vector<std::int64_t> const& lake) const {
        std::unordered_map<std::int64_t, int> count; // looked up only, never walked
        std::vector<std::int64_t> near;
        for (std::int64_t const cell : lake) {
            auto const add = [&](std::int64_t n) {
                if (++count[n] == 1) {
                    near.push_back(n);
                }
            };
            add(cell);
            each_neighbour(labels.grid(), cell, add);
        }
        std::vector<std::int64_t> out;
        std::copy_if(near.begin(), near.end(), std::back_inserter(out),
                     [&](std::int64_t n) { return count[n] >= 5 && is_free(n); });
        return out;
    }

    void take(std::vector<std::int64_t> const& lake) {
        ++last_;
        Grid const& grid = labels.grid();
        for (std::int64_t const cell : lake) {
            labels[cell] = last_;
            cells_around(grid, grid.at(cell), lakes_apart, [&](Cell near) { is_taken_[near] = 1; });
        }
    }

    ChannelsOfArcs const& drawn_;
    std::uint64_t seed_;
    Mask is_taken_;
    std::int32_t last_ = 0;
};

} // namespace

Raster<std::int32_t> choose_lakes(ChannelsOfArcs const& drawn, std::vector<double> const& area_m2,
                                  ChooseLakesParams const& params, Run const& run) {
    check(drawn, area_m2, params);
    Grid const& grid = drawn.channels.grid;
    Shores shores(drawn, params.seed);
    for (std::size_t a = 0; a < area_m2.size(); ++a) {
        run.check();
        double const area = area_m2[a] / (grid.cell_m * grid.cell_m);
        auto const words = random_block(params.seed, lake_stage, ~0ULL, a);
        if (!(area >= params.min_area_cells) || drawn.of_arc[a].empty() || !(unit(words[0]) < params.share)) {
            continue;
        }
        auto const least = static_cast<double>(fewest_lake_cells);
        double const most = std::max(least, std::min(area / 50.0, static_cast<double>(params.max_cells)));
        // Small lakes are many, large ones few: the logarithm is uniform.
        double const size = least * portable::pow(most / least, unit(words[1]));
        shores.grow(a, static_cast<std::int64_t>(size), 0.2 + 0.6 * unit(words[2]));
    }
    return std::move(shores.labels);
}

} // namespace thalweg::network
