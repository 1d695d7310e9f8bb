// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <support.hpp>

#include <thalweg/blend/paste.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>

namespace lands {

using namespace thalweg;

inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Heights between 0 and 100 m, without data in a share of the cells.
inline Raster<float> by_chance(Grid const& grid, std::uint64_t seed, double holes = 0.0) {
    Raster<float> land(grid);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        auto const words = random_block(seed, static_cast<std::uint64_t>(i));
        land[i] = unit(words[1]) < holes ? nan : static_cast<float>(100.0 * unit(words[0]));
    }
    return land;
}

/// A mask of a share of the cells: many parts, holes, single cells.
inline Mask mask_by_chance(Grid const& grid, std::uint64_t seed, double share) {
    Mask mask(grid);
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        mask[i] = unit(random_word(seed, static_cast<std::uint64_t>(i), 77)) < share ? 1 : 0;
    }
    return mask;
}

inline Mask block(Grid const& grid, Cell first, Cell last) {
    return test::raster_of<std::uint8_t>(grid, [&](Cell c) {
        return c.col >= first.col && c.row >= first.row && c.col <= last.col && c.row <= last.row ? 1 : 0;
    });
}

inline blend::Patch patch_of(Raster<float> const& land, Mask const& mask, double lift = 0.0) {
    blend::Patch patch{mask, Raster<double>(land.grid())};
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        patch.z[i] = static_cast<double>(land[i]) + lift;
    }
    return patch;
}

/// The same bits, any NaN like any other.
inline bool same(float a, float b) {
    return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
}

} // namespace lands
