// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <thalweg/blend/deform.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::commands {

/// Options of run_deform().
struct DeformParams {
    std::string target = {}; ///< a DEM, or a mesh: 2DM, OBJ, OFF or GLB
    /// the region: for a DEM a raster on its grid, or polygons; for a mesh polygons around the vertices that move
    std::string mask = {};
    std::string output = {}; ///< a new GeoTIFF; of a mesh in any of io::tin_formats()
    io::Existing existing = io::Existing::refuse;
    /// of a DEM as in blend::DeformParams; of a mesh's slopes, with a rotation of all its lengths
    double scale = 1.0;
    double rotate_deg = 0.0; ///< [degrees] of a mesh, counterclockwise about the axis
    /// of the rotation; one that is not vertical turns the region out of the plane; the vertical if not set
    std::optional<Vec3> axis = {};
    /// [m] positions in the region, and the heights to which they are moved; of a mesh its vertex nearest to each
    std::vector<Vec3> handles = {};
    std::string source_crs = {};    ///< of a mesh without a CRS, projected, in metres; "": the mask's
    io::ReadDemParams reading = {}; ///< how the DEM is read
};

/// A deformed mesh.
struct DeformedTin {
    Tin tin;
    std::string crs;
    std::int64_t vertices = 0;          ///< in the region
    double residual = 0.0;              ///< as blend::PastedTin
    std::vector<Finding> findings = {}; ///< how the mesh was read
};

/// A deformed DEM.
struct DeformedDem : blend::DeformedDem {
    std::vector<Finding> findings = {}; ///< how it was read
};

/// What run_deform() returns: a DEM or a mesh, as the target is.
using DeformResult = std::variant<DeformedDem, DeformedTin>;

/// Runs `thalweg deform`: reads a DEM or a mesh, deforms a region of it and writes the result, completely or not at
/// all. DEMs: blend::deform. Meshes: rotates and scales the gradients of triangles whose corners all lie in the region,
/// and reconstructs the mesh around fixed vertices (those outside, and the handles) by blend::paste_tin; vertices
/// outside the region stay bit for bit, without a rotation all x and y too.
/// \param params files and options
/// \return what was written
/// \throws BadParameter when no change is set, or an option does not apply to the target
/// \throws BadInput as the stages, readers and io::OutputFile; when a handle lies outside a DEM, or no vertex of a mesh
/// in the region
///
/// Source: \cite nenu2015, section 4.2; \cite yu2004.
DeformResult run_deform(DeformParams const& params, Run const& run = {});

} // namespace thalweg::commands
