// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/blend/patch.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::blend {

/// Whose differences between neighbours a pasted region has.
enum class Relief : std::uint8_t {
    source, ///< the patch's
    mixed   ///< the larger of the patch's and the target's (Perez et al. 2003)
};

/// What happens in cells of the mask where the patch has no data.
enum class Holes : std::uint8_t {
    leave, ///< they keep the target's heights
    fill   ///< they take the target's relief, fitted to the cells around
};

/// Options of paste().
struct PasteParams {
    Relief relief = Relief::source;
    Holes holes = Holes::leave;
    /// [cells] [0, 1e6] width inside the edge over which the target's relief becomes the patch's
    double feather_cells = 0.0;
    Mask keep = {};           ///< on the target's grid: 1: the cell keeps its height, e.g. rivers; empty: none
    double tolerance = 1e-10; ///< (0, 1) as in solver::PoissonParams
};

/// A target with a pasted patch.
struct Pasted {
    Raster<float> dem;
    std::int64_t cells = 0;  ///< replaced by the patch
    std::int64_t kept = 0;   ///< cells of the mask that keep protects
    std::int64_t holes = 0;  ///< cells of the mask where the patch has no data
    double seam_max_m = 0.0; ///< [m] largest change of a difference across the seam
    double seam_rms_m = 0.0; ///< [m] root of their mean square
    int iterations = 0;      ///< of the solver
    double residual = 0.0;   ///< relative, of the solver
};

/// Pastes a patch into a DEM without a seam: its relief, at the level of its surroundings. With feather, differences
/// are mixed by a smoothstep of the distance from cells that keep their height.
/// \param target [m] by cell; NaN: no data
/// \param patch on the target's grid, at any level
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return outside the mask, in kept cells and in holes left the target bit for bit; elsewhere f with lap f = div g, g:
/// the patch's differences (the target's, where it has none across the seam), and f the target's in the mask's
/// 4-neighbours. No flux across the target's edge and into cells without data. A patch equal to the target, up to a
/// constant, changes nothing. The same bytes for any number of threads.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput naming a cell when patch or keep are on another grid, a height is infinite, no cell would change,
/// or a part of the patch touches no cell that keeps its height
/// \throws NotConverged when the solver does not reach the tolerance
/// \throws Cancelled
///
/// Source: \cite nenu2015, algorithm 1 and eqs 14 to 16; \cite perez2003, Poisson image editing.
Pasted paste(Raster<float> const& target, Patch const& patch, PasteParams const& params = {}, Run const& run = {});

} // namespace thalweg::blend
