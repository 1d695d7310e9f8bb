// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::blend {

/// A cell that is pulled to a height.
struct Handle {
    Cell cell;
    double z = 0.0; ///< [m]
};

/// Options of deform().
struct DeformParams {
    double scale = 1.0;       ///< [-] finite: how much steeper the region becomes; 0 levels it, below 0 inverts it
    double tolerance = 1e-10; ///< (0,1) as solver::PoissonParams
};

/// A target with a region bent.
struct Deformed {
    Raster<float> dem;
    std::int64_t cells = 0; ///< that were bent, handles included
    int iterations = 0;     ///< of the solver
    double residual = 0.0;  ///< relative, of the solver
};

/// Bends a region of a land: its relief scaled, some of its cells pulled to new heights, its edge where it was.
/// \pre a target, NaN where it has no data; a region on its grid; handles, all in the region's cells with data.
/// \param target [m] the DEM that is changed; NaN: no data
/// \param region 1 inside the region
/// \param handles cells with their new heights
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return handles at their heights, rounded to float; outside the region and in cells without data the target bit for
/// bit; elsewhere the heights f with lap f = div (scale g), g the target's own differences, and f the target's in the
/// region's 4-neighbours. Nothing flows across the target's edge and into cells without data. With scale 1 and handles
/// at the heights their cells have, the target bit for bit. A region turned about z is the target laid on itself:
/// place_patch, then paste.
/// \throws BadParameter
/// \throws BadInput naming a cell when the region is on another grid or holds no data, a handle is not in it, is not
/// finite or is given two heights, or a part of the region has neither handle nor neighbour with a height
/// \throws NotConverged
/// \throws Cancelled
///
/// Source: \cite nenu2015, section 4.2 (deformation).
Deformed deform(Raster<float> const& target, Mask const& region, std::vector<Handle> const& handles,
                DeformParams const& params = {}, Run const& run = {});

} // namespace thalweg::blend
