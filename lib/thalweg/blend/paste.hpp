// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/blend/patch.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::blend {

/// Whose differences between neighbours the pasted land has.
enum class Relief : std::uint8_t {
    source, ///< the patch's
    mixed   ///< the greater of the patch's and the target's (Perez et al. 2003)
};

/// What becomes of cells of the mask in which the patch has no height.
enum class Holes : std::uint8_t {
    leave, ///< they keep the target's
    fill   ///< they get the target's relief, bent to the land around them
};

/// Options of paste().
struct PasteParams {
    Relief relief = Relief::source;
    Holes holes = Holes::leave;
    double feather_cells = 0.0; ///< [cells] [0, 1e6] inside the edge over which the target's relief becomes the patch's
    Mask keep = {};           ///< on the target's grid: cells that keep their height, rivers for one; none where empty
    double tolerance = 1e-10; ///< (0,1) as solver::PoissonParams
};

/// A target with a patch in it.
struct Pasted {
    Raster<float> dem;
    std::int64_t cells = 0;  ///< that the patch replaced
    std::int64_t kept = 0;   ///< cells of the mask that keep lets be
    std::int64_t holes = 0;  ///< cells of the mask in which the patch has no height
    double seam_max_m = 0.0; ///< [m] greatest |difference| across the seam less the target's own, cell by cell
    double seam_rms_m = 0.0; ///< [m] root of their mean square
    int iterations = 0;      ///< of the solver
    double residual = 0.0;   ///< relative, of the solver
};

/// Sets a patch into a target without a seam: the patch's relief, at the height of what is around it.
/// \pre a target, NaN where it has no data; a patch on its grid, whose level does not matter.
/// \param target [m] the DEM that is changed; NaN: no data
/// \param patch the patch
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return outside the mask, in kept cells and in holes left the target's heights bit for bit. Elsewhere the heights f
/// with lap f = div g, g the differences of the patch (where it has none across the seam, the target's own), and f the
/// target's in the mask's 4-neighbours: where the patch has heights there too, the patch and the harmonic extension of
/// what the target differs from it by. Nothing flows across the target's edge and into cells without data. Of a patch
/// equal to the target (or higher by a constant) the target. With feather the differences are mixed by a smoothstep of
/// the distance from cells that keep their height. The same bits for any number of threads.
/// \throws BadParameter
/// \throws BadInput naming a cell when patch or keep are on another grid, a height is infinite, no cell would change,
/// or a part of the patch touches no cell that keeps a height
/// \throws NotConverged
/// \throws Cancelled
///
/// Source: \cite nenu2015, algorithm 1 and eqs 14 to 16; \cite perez2003, Poisson image editing.
Pasted paste(Raster<float> const& target, Patch const& patch, PasteParams const& params = {}, Run const& run = {});

} // namespace thalweg::blend
