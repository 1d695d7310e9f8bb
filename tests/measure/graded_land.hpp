// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include <thalweg/flow/route.hpp>

#include "dems.hpp"

/// Rivers by a random land's drainage, and heights such that every step of water falls by k A^-theta, area in m2.
struct GradedLand {
    thalweg::flow::FlowField drainage;
    thalweg::Raster<float> dem;
};

inline GradedLand graded_land(thalweg::Grid const& grid, std::uint64_t seed, double theta, double k) {
    thalweg::Raster<float> rough = rough_dem(grid, seed);
    for (std::int64_t i = 0; i < rough.cells(); ++i) { // towards the south, so that there are long rivers
        rough[i] += 0.05F * static_cast<float>(grid.height - grid.at(i).row);
    }
    GradedLand land{thalweg::flow::route(rough), thalweg::Raster<float>(grid)};
    std::vector<std::int64_t> order(static_cast<std::size_t>(grid.cells()));
    std::iota(order.begin(), order.end(), std::int64_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) {
        return land.drainage.area_cells[a] > land.drainage.area_cells[b];
    });
    auto const offsets = thalweg::d8_offsets(grid);
    for (std::int64_t const i : order) { // water only gains area on its way: whatever is below is done
        if (!goes_on(land.drainage.direction[i])) {
            continue;
        }
        std::size_t const way = index_of(land.drainage.direction[i]);
        double const area_m2 = static_cast<double>(land.drainage.area_cells[i]) * grid.cell_m * grid.cell_m;
        double const step_m = grid.cell_m / thalweg::d8_per_length[way];
        land.dem[i] = static_cast<float>(static_cast<double>(land.dem[i + offsets[way]]) +
                                         k * std::pow(area_m2, -theta) * step_m);
    }
    return land;
}
