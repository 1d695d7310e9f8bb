// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: Poisson's equation as in paste.hpp, with the terrain's own differences: scaled by a factor
// inside the region, its edge and some handles held at given heights. The terrain follows the
// handles as a membrane would, and keeps its relief: what changes is smooth but at handles.
// Source: Northeast Normal University 2015, section 4.2.
// Cost: one Poisson solution on the region's bounding box, as paste.hpp. All cores, or OpenCL.
// Not for: rotation, which is place_patch and paste; single cells as handles, which leave spikes:
// hold a few cells around each. Water may not run any more: condition the result.
// Example:
//     std::vector<Handle> const handles = {{.cell = {40, 30}, .z = 700.0}};
//     DeformedDem const gentler = deform(dem, land, handles, {.scale = 0.5}); // land: the region
//     Raster<float> const& dem_m = gentler.dem;
// More: docs/rivers.md, "Blending"; docs/commands.md, "Paste and deform".

namespace thalweg::blend {

/// A cell and its new height.
struct Handle {
    Cell cell;
    double z = 0.0; ///< [m]
};

/// Options of deform().
struct DeformParams {
    double scale = 1.0;       ///< [-] factor of slopes; 0 flattens the region, below 0 inverts it
    double tolerance = 1e-10; ///< (0, 1) as in solver::PoissonParams
};

/// A target with a deformed region.
struct DeformedDem {
    Raster<float> dem;
    std::int64_t cells = 0; ///< deformed, handles included
    int iterations = 0;     ///< of the solver
    double residual = 0.0;  ///< relative, of the solver
};

/// Deforms a region of a DEM: scales its relief and moves some of its cells to new heights, without a seam at its edge.
/// \param target [m] by cell; NaN: no data
/// \param region by cell of the target; not 0: inside
/// \param handles cells of the region with data, and their heights
/// \return handles at their heights, rounded to float; outside the region the target bit for bit; elsewhere f with lap
/// f = div (scale g), g: the target's differences, and f the target's in the region's 4-neighbours. No flux across the
/// target's edge and into cells without data. With scale 1 and handles at their present heights, the target bit for
/// bit. To rotate a region, use place_patch and paste.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput naming a cell when the region is on another grid or has no data, a handle is outside it, not finite
/// or given twice with two heights, or a part of the region has neither handle nor neighbour with data
/// \throws NotConverged when the solver does not reach the tolerance
///
/// Source: \cite nenu2015, section 4.2 (deformation).
DeformedDem deform(Raster<float> const& target, Mask const& region, std::vector<Handle> const& handles,
                   DeformParams const& params = {}, Run const& run = {});

} // namespace thalweg::blend
