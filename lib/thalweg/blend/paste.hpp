// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: The eye sees differences, not heights. A patch keeps its differences between neighbours and
// takes the target's heights at its edge: the terrain whose differences come closest to these is
// the solution of Poisson's equation. Solved is the shift from the patch, which without a feather
// is harmonic: a membrane between the differences at the edge carries the patch. So a patch that is
// the target's own, or higher by a constant, changes nothing. ResultCache cells, such as rivers, are fixed
// as the edge is. With a feather the target's differences fade into the patch's over some cells;
// `mixed` takes whichever is larger.
// Source: Pérez, Gangnet and Blake 2003; Northeast Normal University 2015, algorithm 1 and
// equations 14 to 16; on a grid its triangles have the weights of the five-point stencil. What
// stays and how seams are measured: docs/decisions/0012-blending.md.
// Cost: one Poisson solution on the patch's bounding box. docs/performance.md: 60 ns and 43 bytes
// a cell for 1024 x 1024. All cores, or OpenCL.
// Not for: drainage: valleys of the patch end at its edge, and pits form where they meet kept
// rivers; condition the result (flow/condition.hpp). Meshes: tin.hpp. A patch far steeper than its
// surroundings stays so: give a gain.
// Example:
//     Patch const patch = place_patch(other_dem, dem.grid(), {.rotate_deg = 20.0, .gain = 0.8});
//     PastedDem const pasted = paste(dem, patch, {.feather_cells = 12.0});
//     double const seam_m = pasted.seam_rms_m;
// More: docs/rivers.md, "Blending".

namespace thalweg::blend {

/// A piece of terrain placed on a target's grid.
struct Patch {
    Mask mask;                ///< cells that the patch replaces
    Raster<double> z;         ///< [m] its heights, also outside the mask; NaN: no data
    std::int64_t outside = 0; ///< requested cells that lie off the source
};

/// A window of a source, from its north-west.
struct SourceWindow {
    std::int64_t col = 0;
    std::int64_t row = 0;
    std::int64_t width = 0;  ///< [cells] >= 1
    std::int64_t height = 0; ///< [cells] >= 1
};

/// Options of place_patch().
struct PlacePatchParams {
    std::optional<Vec2> at = {};             ///< [m] new position of the window's centre; empty: its own
    double rotate_deg = 0.0;                 ///< [deg] in [-360, 360], counterclockwise about the centre
    double scale = 1.0;                      ///< > 0, in plan
    double gain = 1.0;                       ///< finite, of heights
    std::optional<SourceWindow> window = {}; ///< the part of the source to place; empty: all
    Mask part = {};                          ///< on the target's grid: cells that may be replaced; empty: all
};

/// Resamples a DEM onto the grid of another: moved, rotated about the vertical, scaled.
/// \param source [m] by cell, of any cell size; NaN: no data; in the target's coordinates
/// \param target grid of the result
/// \return heights bilinear between cell centres, bit for bit at these (to 1e-6 of a cell); NaN where one is missing or
/// beyond the outline of centres with data. The mask holds the cells of `part` in the window that lie, with all
/// neighbours, inside the outline. The same bits for any number of threads.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when the window leaves the source, part is on another grid or empty, or the mask would be empty:
/// names both extents
///
/// Source: \cite nenu2015, algorithm 1, step 1 and section 4.2 (rotation and scaling).
Patch place_patch(Raster<float> const& source, Grid const& target, PlacePatchParams const& params = {},
                  Run const& run = {});

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
struct PastedDem {
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
/// \return outside the mask, in kept cells and in holes left the target bit for bit; elsewhere f with lap f = div g, g:
/// the patch's differences (the target's, where it has none across the seam), and f the target's in the mask's
/// 4-neighbours. No flux across the target's edge and into cells without data. A patch equal to the target, up to a
/// constant, changes nothing. The same bytes for any number of threads.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput naming a cell when patch or keep are on another grid, a height is infinite, no cell would change,
/// or a part of the patch touches no cell that keeps its height
/// \throws NotConverged when the solver does not reach the tolerance
///
/// Source: \cite nenu2015, algorithm 1 and eqs 14 to 16; \cite perez2003, Poisson image editing.
PastedDem paste(Raster<float> const& target, Patch const& patch, PasteParams const& params = {}, Run const& run = {});

} // namespace thalweg::blend
