// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>

#include "plain_drainage.hpp"

/// DEMs with rivers for the tests of conditioning, and its laws.
namespace scenes {

using namespace thalweg;
using plain::no_data;

inline Valley no_rivers(Grid const& grid) {
    return {Raster<float>(grid, no_data)};
}

inline std::vector<Cell> beside(Grid const& grid, Cell at) {
    std::vector<Cell> out;
    for (Cell const step : d8_steps) {
        if (Cell const n{at.col + step.col, at.row + step.row}; grid.contains(n)) {
            out.push_back(n);
        }
    }
    return out;
}

/// A land of any roughness, with holes, and rivers in it that fall to its border or run level.
struct Scene {
    Raster<float> dem;
    Valley valley;
};

inline Scene any_scene() {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 15).as("width");
    auto const height = *rc::gen::inRange<std::int64_t>(1, 15).as("height");
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
    auto const rivers = *rc::gen::inRange(0, 4).as("rivers");
    bool const stepped = *rc::gen::arbitrary<bool>().as("stepped");
    double const holes = *rc::gen::element(0.0, 0.0, 0.1).as("holes");
    Scene scene{Raster<float>(test::frame(width, height)), no_rivers(test::frame(width, height))};
    Grid const& grid = scene.dem.grid();
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        double const u = 40.0 * unit(random_word(seed, 1, static_cast<std::uint64_t>(i)));
        bool const hole = unit(random_word(seed, 2, static_cast<std::uint64_t>(i))) < holes;
        scene.dem[i] = hole ? no_data : static_cast<float>(stepped ? std::floor(u / 8.0) : u);
    }
    std::uint64_t draw = 0;
    auto const pick = [&](std::int64_t n) {
        return static_cast<std::int64_t>(random_word(seed, 3, ++draw) % static_cast<std::uint64_t>(n));
    };
    // All on one clock, so that where rivers meet the later, lower one goes on.
    double z = 30.0;
    for (int r = 0; r < rivers; ++r) {
        Cell at{pick(width), pick(height)};
        for (bool on = true; on; at = {at.col + pick(3) - 1, at.row + pick(3) - 1}) {
            on = grid.contains(at);
            if (on) {
                z -= 0.05 * static_cast<double>(pick(3));
                scene.valley.z[at] = scene.dem[at] = static_cast<float>(z);
            }
        }
    }
    return scene;
}

inline bool leaves(Raster<float> const& dem, Cell at) {
    auto const around = beside(dem.grid(), at);
    return around.size() < 8 || std::any_of(around.begin(), around.end(), [&](Cell n) { return std::isnan(dem[n]); });
}

inline void require_drained(Raster<float> const& dem, Valley const& valley) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const at = dem.grid().at(i);
        if (std::isnan(dem[i]) || !std::isnan(valley.z[i]) || leaves(dem, at)) {
            continue;
        }
        auto const around = beside(dem.grid(), at);
        RC_ASSERT(std::any_of(around.begin(), around.end(), [&](Cell n) { return dem[n] < dem[i]; }));
    }
}

inline void require_rivers_untouched(Raster<float> const& dem, Scene const& scene) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (!std::isnan(scene.valley.z[i])) {
            RC_ASSERT(std::bit_cast<std::uint32_t>(dem[i]) == std::bit_cast<std::uint32_t>(scene.dem[i]));
        }
        RC_ASSERT(std::isnan(dem[i]) == std::isnan(scene.dem[i]));
    }
}

/// The law of confine_channels.
inline void require_water_kept(Raster<float> const& dem, Valley const& valley) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isnan(valley.z[i])) {
            continue;
        }
        Cell const at = dem.grid().at(i);
        double steepest_river = 0.0;
        double lowest_river = std::numeric_limits<double>::infinity();
        double steepest_land = 0.0;
        double lowest_land = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < 8; ++k) {
            Cell const n{at.col + d8_steps[k].col, at.row + d8_steps[k].row};
            if (!dem.grid().contains(n) || std::isnan(dem[n])) {
                continue;
            }
            double const length = k % 2 == 0 ? 1.0 : std::sqrt(2.0);
            double const slope = (static_cast<double>(dem[at]) - static_cast<double>(dem[n])) / length;
            bool const river = !std::isnan(valley.z[n]);
            double& steepest = river ? steepest_river : steepest_land;
            double& lowest = river ? lowest_river : lowest_land;
            steepest = std::max(steepest, slope);
            lowest = std::min(lowest, static_cast<double>(dem[n]));
        }
        if (steepest_river > 0.0) {
            RC_ASSERT(steepest_land < steepest_river);
            RC_ASSERT(lowest_river < lowest_land);
        } else {
            RC_ASSERT(lowest_land > static_cast<double>(dem[i]));
        }
    }
}

} // namespace scenes
