// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::flow {

/// [m] what water needs to run, at least: about a unit in the last place of a float at 200 m. Near 0, where such units
/// vanish, no reader of a DEM would see less.
inline constexpr float small_step = 0x1p-16F;

/// The least height above z that counts.
inline float just_above(float z) {
    float const above = z + small_step;
    if (above > z) {
        return above;
    }
    auto const bits = std::bit_cast<std::uint32_t>(z);
    return std::bit_cast<float>(z > 0.0F ? bits + 1 : bits - 1);
}

/// The greatest height below z that counts.
inline float just_below(float z) {
    return -just_above(-z);
}

enum class Lakes : std::uint8_t { level, slope };

/// Raises a framed DEM (framed) to the water of its lakes, level or sloping by small steps towards their outlets.
/// Water leaves at the border, into no data and into river cells (those with a height in the framed valley).
void flood(Raster<float>& land, Raster<float> const& rivers, Lakes lakes, Run const& run);

/// Throws: BadInput: different frames, no cells, an infinite height, a river cell without land.
void check_drainable(Raster<float> const& dem, Valley const& valley);

/// Raises depressions to where they spill, and above that as little as lets water run.
/// Takes: a DEM whose river cells stand at the valley's heights (NaN where there is no river); rivers lead out of the
/// grid, down or level.
/// Gives: every cell with data has a strictly lower neighbour, is a river's, or lies at the grid's border or beside no
/// data. Only land is raised, none is lowered: each cell to the least height above both itself and the lowest way out,
/// by steps of one unit in the last place or 2^-16 m.
/// Throws: BadInput: another frame, no cells, an infinite height; Cancelled.
/// Source: Barnes, Lehman and Mulla 2014 (priority-flood with small steps).
Raster<float> fill(Raster<float> const& dem, Valley const& valley, Run const& run = {});

/// Drains depressions with the least volume moved: of each, the cheapest of filling it, of cutting its lowest cell a
/// way out, and, among rivers, of filling it part of the way (in eighths of its depth) and cutting from there. A cut
/// leaves the smaller depressions in it to be treated in turn.
/// Takes: as fill; least: what cells must not be cut below (confine_channels), NaN where any depth will do.
/// Gives: drained as after fill, which does the rest; no more volume than fill would move; river cells as they were,
/// no cell cut below its least. A cut follows the way on which it moves the least, and falls by small steps to a cell
/// that drains: lower land, a river, the border or no data.
/// Throws: as fill.
/// Source: Soille 2004; Lindsay 2016 (least-cost breaching); Barnes, Lehman and Mulla 2014.
Raster<float> carve(Raster<float> const& dem, Valley const& valley, Raster<float> const& least, Run const& run = {});

struct RaiseBanksParams {
    double margin_m = 0.002; ///< [m] >= 0: tools that count in millimetres (r.watershed) must see the bank
};

struct Banks {
    Raster<float> dem;
    Raster<float> least; ///< [m] what a cell beside a river must not be cut below, NaN for other cells
};

/// Raises the cells beside rivers as little as keeps each river's water in it.
/// Takes: a DEM whose river cells stand at the valley's heights.
/// Gives: of a river cell with a lower river cell beside it, the way down the steepest slope and the lowest neighbour
/// are river cells; a river cell without one (an outlet, a flat reach) has higher land around it. River cells and cells
/// without data stay as they are, and no cell is raised higher than this takes.
/// Throws: BadInput when the rasters have different frames; BadParameter.
Banks confine_channels(Raster<float> const& dem, Valley const& valley, RaiseBanksParams const& params = {},
                       Run const& run = {});

} // namespace thalweg::flow
