// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/blend/deform.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::pipeline {

/// Options of make_deform().
struct MakeDeformParams {
    std::string target = {};           ///< a DEM
    std::string mask = {};             ///< the region: a raster on the target's grid, or polygons
    double scale = 1.0;                ///< as in blend::DeformParams
    std::vector<Vec3> handles = {};    ///< [m] positions in the region, and the heights to which they are moved
    std::optional<double> nodata = {}; ///< of the DEM, as in io::ReadDemParams
};

/// Reads a DEM and deforms a region of it.
/// \param params files and options
/// \return as blend::deform
/// \throws BadInput as the stage and the readers; when a handle lies outside the target, or no change is set
blend::Deformed make_deform(MakeDeformParams const& params, Run const& run = {});

/// Options of make_deform_tin().
struct MakeDeformTinParams {
    std::string target = {};        ///< a mesh: 2DM, OBJ or OFF
    std::string mask = {};          ///< polygons around the vertices that move
    double scale = 1.0;             ///< of the region's slopes; with a rotation of all its lengths
    double rotate_deg = 0.0;        ///< [degrees] counterclockwise about the axis
    Vec3 axis = {0.0, 0.0, 1.0};    ///< of the rotation; one that is not vertical turns the region out of the plane
    std::vector<Vec3> handles = {}; ///< [m] positions whose nearest vertex in the region is moved to the height
    std::string source_crs = {};    ///< of a mesh without a CRS, projected, in metres; "": the mask's
};

/// What make_deform_tin() returns.
struct DeformedTin {
    Tin tin;
    std::string crs;
    std::int64_t vertices = 0; ///< in the region
    double residual = 0.0;     ///< as blend::PastedTin
};

/// Reads a mesh and deforms a region of it: rotates and scales the gradients of triangles whose corners all lie in the
/// region, and reconstructs the mesh around fixed vertices (those outside, and the handles).
/// \return as blend::paste_tin; vertices outside the region bit for bit; without a rotation all x and y too
/// \throws BadParameter when no change is set
/// \throws BadInput as read_tin, read_polygons and paste_tin, and when no vertex is in the region
///
/// Source: \cite nenu2015, section 4.2; \cite yu2004.
DeformedTin make_deform_tin(MakeDeformTinParams const& params, Run const& run = {});

} // namespace thalweg::pipeline
