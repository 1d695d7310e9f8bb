// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/lanes.hpp>
#include <thalweg/core/run/large_pages.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>

/// Inside of expand and dilate: the lexicographic (level, base) transform as one sweep down and one up, without
/// barriers. A row is scanned both ways, then the columns: the smallest pair (|c - v|, e_v) over all valley cells v.
namespace thalweg::surface::separable {

/// \param height [m] a height
/// \return an integer in the order of the float: total, -0 below +0, so that no minimum depends on the order of
/// comparison.
inline std::int32_t ordered(float height) {
    auto const bits = std::bit_cast<std::int32_t>(height);
    return bits ^ ((bits >> 31) & 0x7fffffff);
}
inline float height_of(std::int32_t order) {
    return std::bit_cast<float>(order ^ ((order >> 31) & 0x7fffffff));
}

/// Values of the free cells.
struct Free {
    void operator()(void* memory) const { give_large_pages(memory); }
};

/// What is known after the sweep down. Level: std::uint16_t where fits16(grid), else std::int32_t.
template <class Level> struct Swept {
    std::unique_ptr<Level[], Free> level; ///< of each cell, counted from the valley cells above and beside it
    float greatest = 0.0F;   ///< [m] greatest |height| of a valley cell; infinite if one is; < 0 without any
    std::int64_t levels = 0; ///< greatest number of dilations after both sweeps
};

/// \param swept what sweep_down found
/// \return whether the valley has cells, and finite heights in them.
template <class Level> bool usable(Swept<Level> const& swept) {
    return swept.greatest >= 0.0F && swept.greatest < std::numeric_limits<float>::infinity();
}

inline bool fits16(Grid const& grid) {
    return grid.width + grid.height <= 0xffff;
}

/// \pre a valley of at least one cell
/// \param valley [m] heights of the river cells
/// \param base any content, the valley's grid
/// \param lanes width of the vector registers; any gives the same bytes
/// \param run progress, log, stop token and number of threads
/// \return level, and in base the heights of the cells they are counted from.
template <class Level> Swept<Level> sweep_down(Valley const& valley, Raster<float>& base, Lanes lanes, Run const& run);

/// Finishes base in place and writes the levels.
/// \param swept what sweep_down found
/// \param base [m] base heights
/// \param level receives the number of dilations
/// \param lanes width of the vector registers; any gives the same bytes
/// \param run progress, log, stop token and number of threads
template <class Level>
void sweep_up(Swept<Level> const& swept, Raster<float>& base, Raster<std::int32_t>& level, Lanes lanes, Run const& run);

/// Turns base in place into heights: base + above_valley[level], added in double. Valley cells keep their bits.
/// \param swept what sweep_down found
/// \param base [m] base heights
/// \param above_valley [m] height above the valley by number of dilations
/// \param lanes width of the vector registers; any gives the same bytes
/// \param run progress, log, stop token and number of threads
template <class Level>
void sweep_up(Swept<Level> const& swept, Raster<float>& base, std::vector<double> above_valley, Lanes lanes,
              Run const& run);

} // namespace thalweg::surface::separable
