// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/dilation/dilate.hpp>

#include <thalweg/surface/dilation/internal/check_valley.hpp>
#include <thalweg/surface/dilation/separable.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace thalweg::surface {
namespace {

template <class Level> Expansion expand_as(Valley const& valley, Run const& run) {
    Lanes const lanes = widest_lanes();
    Expansion expansion{Raster<std::int32_t>(valley.z.grid()), Raster<float>(valley.z.grid())};
    auto const swept = separable::sweep_down<Level>(valley, expansion.base, lanes, run);
    if (!separable::usable(swept)) {
        check_heights(valley.z);
    }
    separable::sweep_up(swept, expansion.base, expansion.level, lanes, run);
    return expansion;
}

} // namespace

Expansion expand_frontier(Valley const& valley, Mask const& inside, Run const& run) {
    Grid const& grid = valley.z.grid();
    check_frame(grid);
    check_mask(grid, inside.grid());
    Expansion expansion{Raster<std::int32_t>(grid, -1), valley.z};
    Raster<std::int32_t>& level = expansion.level;
    Raster<float>& base = expansion.base;
    std::vector<std::int64_t> frontier;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (inside[i] == 0 || std::isnan(base[i])) {
            base[i] = std::numeric_limits<float>::quiet_NaN();
        } else {
            level[i] = 0;
            frontier.push_back(i);
        }
    }
    check_heights(base);
    std::vector<std::int64_t> next;
    for (std::int32_t x = 1; !frontier.empty(); ++x) {
        run.check();
        next.clear();
        for (std::int64_t const from : frontier) {
            auto const spread = [&](std::int64_t to) {
                if (level[to] < 0 && inside[to] != 0) {
                    level[to] = x;
                    base[to] = base[from];
                    next.push_back(to);
                } else if (level[to] == x && separable::ordered(base[from]) < separable::ordered(base[to])) {
                    base[to] = base[from];
                }
            };
            std::int64_t const col = from % grid.width;
            if (col > 0) {
                spread(from - 1);
            }
            if (col + 1 < grid.width) {
                spread(from + 1);
            }
            if (from >= grid.width) {
                spread(from - grid.width);
            }
            if (from + grid.width < grid.cells()) {
                spread(from + grid.width);
            }
        }
        frontier.swap(next);
    }
    return expansion;
}

Expansion expand(Valley const& valley, Run const& run) {
    check_frame(valley.z.grid());
    return separable::fits16(valley.z.grid()) ? expand_as<std::uint16_t>(valley, run)
                                              : expand_as<std::int32_t>(valley, run);
}

} // namespace thalweg::surface
