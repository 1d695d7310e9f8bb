// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::flow {

/// [m] the least fall with which water runs: about one ulp of a float at 200 m. Near 0, where one ulp is far smaller,
/// no reader of a DEM would notice less.
inline constexpr float small_step = 0x1p-16F;

/// \return the least height above z that counts as higher.
inline float just_above(float z) {
    float const above = z + small_step;
    if (above > z) {
        return above;
    }
    auto const bits = std::bit_cast<std::uint32_t>(z);
    return std::bit_cast<float>(z > 0.0F ? bits + 1 : bits - 1);
}

/// \return the greatest height below z that counts as lower.
inline float just_below(float z) {
    return -just_above(-z);
}

/// A queue that returns the lowest cell first; ties by index.
using LowestCell =
    std::priority_queue<std::pair<float, CellIndex>, std::vector<std::pair<float, CellIndex>>, std::greater<>>;

enum class Lakes : std::uint8_t { level, slope };

/// Finds, by one look at each cell, those from which water does not fall.
/// \param dem [m] by cell; NaN: no data; no height is infinite
/// \param rivers [m] on its grid; NaN: no river
/// \return ascending: no river cells, not at the grid's border, not beside no data, and lower than just_above() their
/// lowest neighbour. None: flooded() with sloping lakes changes nothing.
std::vector<CellIndex> undrained_cells(Raster<float> const& dem, Raster<float> const& rivers, Run const& run);

/// Fills a DEM up to the water level of its lakes, level or sloping by small steps towards their outlets. Water leaves
/// at the border, into no data and into river cells.
/// \param dem,rivers as for undrained_cells()
/// \param cells_per_lake where there are fewer cells for each undrained one, all are flooded; otherwise only those that
/// the lakes of undrained cells can reach. Changes nothing but the time.
///
/// Source: \cite barnes2014.
Raster<float> flooded(Raster<float> dem, Raster<float> const& rivers, Lakes lakes, Run const& run,
                      std::int64_t cells_per_lake = 16);

/// Checks the input of fill(), carve() and confine_channels().
/// \throws BadInput when frames differ, there are no cells, a height is infinite, or a river cell has no height
void check_drainable(Raster<float> const& dem, Valley const& valley, Run const& run = {});

/// Fills depressions to their spill level, and above it by the least that lets water run.
/// \param dem [m] river cells have the valley's heights
/// \param valley [m] NaN: no river; rivers run out of the grid, downhill or level
/// \return every cell with data has a strictly lower neighbour, is a river cell, or lies at the grid's border or beside
/// no data. Cells are only raised, each to the least height above both itself and its lowest exit, by steps of one ulp
/// or 2^-16 m.
/// \throws BadInput when frames differ, there are no cells, or a height is infinite
///
/// Source: \cite barnes2014 (priority-flood with small steps).
Raster<float> fill(Raster<float> const& dem, Valley const& valley, Run const& run = {});

/// Drains each depression by moving the least volume: by filling it, by cutting an outlet from its lowest cell, or,
/// among rivers, by filling it part of the way (in eighths of its depth) and cutting from there. Smaller depressions
/// that a cut leaves are treated in turn.
/// \param dem,valley as for fill()
/// \param least [m] cells must not be cut below (confine_channels); NaN: no limit
/// \return once filled, drained as after fill(); moves no more volume than fill(); river cells are unchanged, no cell
/// is cut below its least. A cut follows the path on which it moves the least and falls by small steps to a cell that
/// drains: lower terrain, a river, the border or no data.
/// \throws BadInput as fill()
///
/// Source: Soille 2004; Lindsay 2016 (least-cost breaching); \cite barnes2014.
Raster<float> carve(Raster<float> const& dem, Valley const& valley, Raster<float> const& least, Run const& run = {});

/// [m] Heights of some cells.
struct SparseHeights {
    std::vector<CellIndex> cell; ///< ascending
    std::vector<float> z;        ///< by place in cell

    /// \param i one of the cells
    float of(CellIndex i) const;
};

/// \param by_cell [m] NaN: no height
SparseHeights sparse_heights(Raster<float> const& by_cell);

/// What carve() does where something does not drain yet.
/// \param dem,valley,least as for carve(), checked
/// \return as carve(), also of terrain that drains already: that terrain
Raster<float> carve_depressions(Raster<float> const& dem, Valley const& valley, SparseHeights const& least,
                                Run const& run);

struct RaiseBanksParams {
    double margin_m = 0.002; ///< [m] >= 0: tools that work in millimetres (r.watershed) must still see the bank
};

struct Banks {
    Raster<float> dem;
    Raster<float> least; ///< [m] cells beside a river must not be cut below this; NaN: other cells
};

/// Raises the cells beside rivers by the least that keeps each river's water in its channel.
/// \param dem [m] river cells have the valley's heights
/// \return the steepest and the lowest lower neighbour of a river cell with a lower river neighbour are river cells; a
/// river cell without one (an outlet, a flat reach) is surrounded by higher terrain. River cells and cells without data
/// are unchanged.
/// \throws BadInput when the rasters have different frames
/// \throws BadParameter when margin_m is negative
Banks confine_channels(Raster<float> const& dem, Valley const& valley, RaiseBanksParams const& params = {},
                       Run const& run = {});

} // namespace thalweg::flow
