// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include <thalweg/blend/tin.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/pipeline/make/blend_into.hpp>

namespace thalweg::pipeline {

/// Reads two DEMs and pastes a patch of one into the other: place_patch, then paste. A source in another CRS or with
/// other cells is warped first, after its window is cut out: to the target's CRS if both lie in the same part of the
/// earth; otherwise it is measured in its own CRS or, if that is not in metres, in its UTM zone. Of lines to keep, the
/// parts that cross the target count.
/// \param params files and options
/// \return as the stages
/// \throws BadInput as the stages and readers; when keep is neither a raster nor lines, or has no cells on the target;
/// when a rotated patch is pasted into a target in degrees
MadeBlend make_blend(MakeBlendParams const& params, Run const& run = {});

/// Options of make_blend_tin().
struct MakeBlendTinParams {
    std::string target = {};     ///< a mesh that read_tin reads
    std::string source = {};     ///< the patch, another mesh
    std::optional<Vec2> at = {}; ///< [m] on the target: position of the centre of the patch's box
    double rotate_deg = 0.0;     ///< [-360, 360] counterclockwise about that centre
    double scale = 1.0;          ///< > 0, in plan
    double gain = 1.0;           ///< finite, of heights
    std::string source_crs = {}; ///< of meshes without a CRS, projected, in metres; "": none
};

/// A blended mesh and its placement.
struct MadeBlendTin {
    blend::FusedTin fused;
    std::string crs;
    PatchPlace place = PatchPlace::given;
    Vec2 at; ///< [m] centre of the patch's box
};

/// Reads two meshes and pastes one into the other: moved, rotated and scaled, then fuse_tin.
/// \param params files and options. Without a position the patch keeps its coordinates, bit for bit if it is neither
/// rotated nor scaled; if its box does not meet the target's, it is moved to the centre of the target's box
/// \return the mesh, and its placement
/// \throws BadInput as read_tin and fuse_tin, and for meshes in different CRS
MadeBlendTin make_blend_tin(MakeBlendTinParams const& params, Run const& run = {});

} // namespace thalweg::pipeline
