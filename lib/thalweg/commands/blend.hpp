// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <thalweg/blend/tin.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/make/blend_into.hpp>

namespace thalweg::commands {

/// Options of run_blend().
struct BlendParams {
    /// Target and patch: two DEMs, or two meshes that io::read_tin reads. For meshes at is the position of the centre
    /// of the patch's box, rotate_deg is in [-360, 360] about that centre, and mask, window, keep, feather_cells,
    /// relief, holes and nodata stay at their defaults.
    make::BlendIntoParams patch = {};
    std::string output = {}; ///< a new GeoTIFF; for meshes in any of io::tin_formats()
    io::Existing existing = io::Existing::refuse;
    std::string source_crs = {}; ///< of meshes without a CRS, projected, in metres; "": none
};

/// A blended mesh and its placement.
struct BlendedTin {
    blend::FusedTin fused;
    std::string crs;
    make::PatchPlace place = make::PatchPlace::given;
    Vec2 at;                            ///< [m] centre of the patch's box
    std::vector<Finding> findings = {}; ///< how the meshes were read
};

/// What run_blend() returns: a DEM or a mesh, as the target is.
using BlendResult = std::variant<make::BlendedDem, BlendedTin>;

/// Runs `thalweg blend`: reads two DEMs or two meshes and writes the first with a patch of the second, completely or
/// not at all. DEMs: blend_into; of lines to keep, the parts that cross the target count. Meshes: the patch is moved,
/// rotated and scaled, then blend::fuse_tin; without a position it keeps its coordinates, bit for bit if it is neither
/// rotated nor scaled; if its box does not meet the target's, it is moved to the centre of the target's box.
/// \param params files and options
/// \return what was written, and its placement
/// \throws BadParameter when an option does not apply to the files
/// \throws BadInput as the stages, readers and io::OutputFile; when keep is neither a raster nor lines, or has no cells
/// on the target; when a rotated patch is pasted into a target in degrees; for meshes in different CRS
BlendResult run_blend(BlendParams const& params, Run const& run = {});

} // namespace thalweg::commands
