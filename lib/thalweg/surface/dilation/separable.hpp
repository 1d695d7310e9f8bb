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
#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/run.hpp>

/// Implementation of expand and dilate without barriers: the lexicographic (level, base) transform by one sweep down
/// and one up, i.e. for each cell the least pair (|c - v|, e_v) over all valley cells v.
namespace thalweg::surface::separable {

/// Maps a float to an integer of the same order.
/// \param height not NaN
/// \return a total order, -0 below +0, so that minima do not depend on the order of comparison
inline std::int32_t ordered(float height) {
    auto const bits = std::bit_cast<std::int32_t>(height);
    return bits ^ ((bits >> 31) & 0x7fffffff);
}
inline float height_of(std::int32_t order) {
    return std::bit_cast<float>(order ^ ((order >> 31) & 0x7fffffff));
}

/// Deleter of memory from allocate_large_pages.
struct Free {
    void operator()(void* memory) const { free_large_pages(memory); }
};

/// The state after the sweep down. Level is std::uint16_t where fits16(grid), else std::int32_t.
template <class Level> struct Swept {
    std::unique_ptr<Level[], Free> level; ///< by cell: distance to the valley cells in its row and above
    float greatest = 0.0F;   ///< [m] largest |height| of a valley cell; infinite if one is; < 0: no valley cell
    std::int64_t levels = 0; ///< largest number of dilations after both sweeps
};

/// Tells whether a valley has cells, all of finite height.
/// \param swept as sweep_down returns it
/// \return true: sweep_up may follow
template <class Level> bool usable(Swept<Level> const& swept) {
    return swept.greatest >= 0.0F && swept.greatest < std::numeric_limits<float>::infinity();
}

inline bool fits16(Grid const& grid) {
    return grid.width + grid.height <= 0xffff;
}

/// Sweeps from north to south.
/// \param valley [m] at least one river cell
/// \param base any content, the valley's grid; receives the heights that levels are counted from
/// \param lanes instruction set; the bytes are the same for each
/// \return the levels after this sweep
template <class Level> Swept<Level> sweep_down(Valley const& valley, Raster<float>& base, Lanes lanes, Run const& run);

/// Sweeps from south to north, which finishes base and level.
/// \param swept as sweep_down returns it
/// \param base [m] as sweep_down left it; finished in place
/// \param level receives the number of dilations
/// \param lanes instruction set; the bytes are the same for each
template <class Level>
void sweep_up(Swept<Level> const& swept, Raster<float>& base, Raster<std::int32_t>& level, Lanes lanes, Run const& run);

/// Sweeps from south to north and turns base into heights: base + above_valley[level], added in double. Valley cells
/// keep their bits.
/// \param swept as sweep_down returns it
/// \param base [m] as sweep_down left it; receives the heights
/// \param above_valley [m] by number of dilations
/// \param lanes instruction set; the bytes are the same for each
template <class Level>
void sweep_up(Swept<Level> const& swept, Raster<float>& base, std::vector<double> above_valley, Lanes lanes,
              Run const& run);

} // namespace thalweg::surface::separable
