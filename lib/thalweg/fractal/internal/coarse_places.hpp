// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/fractal/refine.hpp>

/// What the coarse raster tells of a point of a level, by the point's column and row.
namespace thalweg::fractal {

struct LocalCharacter {
    float step;  ///< H in steps of Character::steps_of_hurst
    float sigma; ///< [m] a coarse cell apart
};

/// Bilinear between the coarse points; for a character that varies.
inline LocalCharacter character_at(Refinement const& refinement, int level, std::int64_t col, std::int64_t row) {
    Character const& character = refinement.character;
    std::int64_t const width = refinement.coarse->width();
    std::int64_t const side = std::int64_t{1} << level;
    float const x = static_cast<float>(col & (side - 1)) / static_cast<float>(side);
    float const y = static_cast<float>(row & (side - 1)) / static_cast<float>(side);
    std::int64_t const north_west = (row >> level) * width + (col >> level);
    std::int64_t const east = x > 0.0F ? 1 : 0;
    std::int64_t const south = y > 0.0F ? width : 0;
    auto const between = [&](Indexed<CellIndex, float> const& of) {
        float const north_z = of[north_west] + x * (of[north_west + east] - of[north_west]);
        float const south_z = of[north_west + south] + x * (of[north_west + south + east] - of[north_west + south]);
        return north_z + y * (south_z - north_z);
    };
    return {std::floor(between(character.steps) + 0.5F), between(character.sigmas)};
}

/// Whether all the coarse cells nearest to a point are holes.
inline bool in_hole(Refinement const& refinement, int level, std::int64_t col, std::int64_t row) {
    std::int64_t const side = std::int64_t{1} << level;
    for (std::int64_t const r : {(row + side / 2 - 1) / side, (row + side / 2) / side}) {
        for (std::int64_t const c : {(col + side / 2 - 1) / side, (col + side / 2) / side}) {
            if (!std::isnan((*refinement.coarse)[Cell{c, r}])) {
                return false;
            }
        }
    }
    return true;
}

} // namespace thalweg::fractal
