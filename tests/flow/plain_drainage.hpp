// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/flow/internal/condition.hpp>

/// Filling and breaching as their definitions have them, for comparison.
namespace plain {

using namespace thalweg;

inline constexpr float no_data = std::numeric_limits<float>::quiet_NaN();

inline bool is_way_out(Raster<float> const& dem, std::int64_t i) {
    Cell const at = dem.grid().at(i);
    return std::any_of(d8_steps.begin(), d8_steps.end(), [&](Cell step) {
        Cell const n{at.col + step.col, at.row + step.row};
        return !dem.grid().contains(n) || std::isnan(dem[n]);
    });
}

template <class Visit> void beside(Grid const& grid, std::int64_t i, Visit visit) {
    Cell const at = grid.at(i);
    for (Cell const step : d8_steps) {
        if (Cell const n{at.col + step.col, at.row + step.row}; grid.contains(n)) {
            visit(grid.index(n));
        }
    }
}

/// Lowers a flood until each cell stands at its own height or just above the lowest cell beside it.
inline Raster<float> filled(Raster<float> const& dem, Valley const& valley) {
    Raster<float> level(dem.grid(), std::numeric_limits<float>::infinity());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isnan(dem[i]) || !std::isnan(valley.z[i]) || is_way_out(dem, i)) {
            level[i] = dem[i];
        }
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (std::isnan(dem[i])) {
                continue;
            }
            beside(dem.grid(), i, [&](std::int64_t n) {
                if (level[n] < std::numeric_limits<float>::infinity()) {
                    float const here = std::max(dem[i], flow::just_above(level[n]));
                    changed = changed || here < level[i];
                    level[i] = std::min(level[i], here);
                }
            });
        }
    }
    return level;
}

inline double fill_volume(Raster<float> const& dem) {
    Valley const none{Raster<float>(dem.grid(), no_data)};
    Raster<float> const level = filled(dem, none);
    double volume = 0.0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        volume += std::isnan(dem[i]) ? 0.0 : static_cast<double>(level[i]) - static_cast<double>(dem[i]);
    }
    return volume;
}

/// Whether the water of a river cell would rather go to a cell of land than stay in the river: by its slope, or because
/// nothing beside it is lower.
inline bool prefers(Raster<float> const& dem, Valley const& valley, Cell river, std::int64_t land) {
    double slope_river = 0.0;
    double lowest_river = std::numeric_limits<double>::infinity();
    double slope_land = 0.0;
    double const here = dem[river];
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        Cell const n{river.col + d8_steps[k].col, river.row + d8_steps[k].row};
        if (!dem.grid().contains(n)) {
            continue;
        }
        double const slope = (here - static_cast<double>(dem[n])) / (k % 2 == 0 ? 1.0 : std::sqrt(2.0));
        if (!std::isnan(valley.z[n])) {
            slope_river = std::max(slope_river, slope);
            lowest_river = std::min(lowest_river, static_cast<double>(dem[n]));
        }
        if (dem.grid().index(n) == land) {
            slope_land = slope;
        }
    }
    if (!(slope_river > 0.0)) {
        return static_cast<double>(dem[land]) <= here;
    }
    return slope_land >= slope_river || static_cast<double>(dem[land]) <= lowest_river;
}

namespace detail {

inline void go_on(Raster<float> const& dem, std::int64_t at, double pit, double cost, std::vector<bool>& on_way,
                  double& best) {
    if (cost >= best) {
        return;
    }
    if (dem.grid().on_border(dem.grid().at(at))) {
        best = cost;
        return;
    }
    on_way[static_cast<std::size_t>(at)] = true;
    beside(dem.grid(), at, [&](std::int64_t n) {
        if (!on_way[static_cast<std::size_t>(n)]) {
            go_on(dem, n, pit, cost + std::max(0.0, static_cast<double>(dem[n]) - pit), on_way, best);
        }
    });
    on_way[static_cast<std::size_t>(at)] = false;
}

} // namespace detail

/// Of all simple ways from a pit to the border, the least volume to be cut.
inline double cheapest_way_out(Raster<float> const& dem, Cell pit) {
    double best = 1e9;
    std::vector<bool> on_way(static_cast<std::size_t>(dem.cells()), false);
    detail::go_on(dem, dem.grid().index(pit), static_cast<double>(dem[pit]), 0.0, on_way, best);
    return best;
}

/// Volume of least-cost breaching as Lindsay 2016 has it: pit by pit, the highest first, to the nearest lower cell.
inline double breach_volume(Raster<float> dem) {
    Grid const& grid = dem.grid();
    double volume = 0.0;
    for (;;) {
        std::int64_t pit = -1;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            bool lower = is_way_out(dem, i);
            beside(grid, i, [&](std::int64_t n) { lower = lower || dem[n] < dem[i]; });
            if (!lower && (pit < 0 || dem[i] > dem[pit])) {
                pit = i;
            }
        }
        if (pit < 0) {
            return volume;
        }
        std::vector<double> cost(static_cast<std::size_t>(grid.cells()), 1e30);
        std::vector<std::int64_t> back(cost.size(), -1);
        using Entry = std::pair<double, std::int64_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        cost[static_cast<std::size_t>(pit)] = 0.0;
        queue.emplace(0.0, pit);
        std::int64_t end = -1;
        while (end < 0) {
            double const c = queue.top().first;
            std::int64_t const i = queue.top().second;
            queue.pop();
            if (i != pit && (dem[i] < dem[pit] || is_way_out(dem, i))) {
                end = i;
                break;
            }
            beside(grid, i, [&](std::int64_t n) {
                double const there = c + std::max(0.0, static_cast<double>(dem[n]) - static_cast<double>(dem[pit]));
                if (there < cost[static_cast<std::size_t>(n)]) {
                    cost[static_cast<std::size_t>(n)] = there;
                    back[static_cast<std::size_t>(n)] = i;
                    queue.emplace(there, n);
                }
            });
        }
        std::vector<std::int64_t> way;
        for (std::int64_t i = end; i != pit; i = back[static_cast<std::size_t>(i)]) {
            way.push_back(i);
        }
        float height = dem[pit];
        for (auto i = way.rbegin(); i != way.rend(); ++i) {
            height = flow::just_below(height);
            if (dem[*i] > height) {
                volume += static_cast<double>(dem[*i]) - static_cast<double>(height);
                dem[*i] = height;
            }
        }
    }
}

/// Value noise: heights at random on a lattice of so many cells, bilinear between, and a little for each cell.
inline Raster<float> waves(Grid const& grid, std::int64_t wave, std::uint64_t seed) {
    Raster<float> dem(grid);
    auto const corner = [&](std::int64_t col, std::int64_t row) {
        return unit(random_word(seed, static_cast<std::uint64_t>(wave), static_cast<std::uint64_t>(col),
                                static_cast<std::uint64_t>(row)));
    };
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = grid.at(i);
        double const u = static_cast<double>(c.col % wave) / static_cast<double>(wave);
        double const v = static_cast<double>(c.row % wave) / static_cast<double>(wave);
        std::int64_t const col = c.col / wave;
        std::int64_t const row = c.row / wave;
        double const z = (corner(col, row) * (1 - u) + corner(col + 1, row) * u) * (1 - v) +
                         (corner(col, row + 1) * (1 - u) + corner(col + 1, row + 1) * u) * v;
        dem[i] = static_cast<float>(20.0 * z + unit(random_word(seed, 0, static_cast<std::uint64_t>(i))));
    }
    return dem;
}

} // namespace plain
