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

/// Reads two DEMs and sets a patch of the one into the other: place_patch, then paste.
/// \param params files
/// \return as the stages do. A source in another CRS or with other cells is warped first, a window cut out of it
/// before: into the target's CRS where both lie on the same part of the earth; else it is measured in its own CRS or,
/// where that is not in metres, in its UTM zone. Of lines to keep those parts count that cross the target.
/// \throws BadInput as the stages and doors do, also when keep is neither a raster nor lines, none of whose cells are
/// the target's, or a target in degrees is asked to take a turned patch
MadeBlend make_blend(MakeBlendParams const& params, Run const& run = {});

/// Options of make_blend_tin().
struct MakeBlendTinParams {
    std::string target = {};     ///< a mesh that read_tin reads
    std::string source = {};     ///< the patch, another
    std::optional<Vec2> at = {}; ///< [m] of the target: where the middle of the patch's box comes to lie
    double rotate_deg = 0.0;     ///< [-360, 360] counterclockwise about that middle
    double scale = 1.0;          ///< > 0, in plan
    double gain = 1.0;           ///< finite, of heights
    std::string source_crs = {}; ///< of meshes that name none, projected, in metres; "" for none
};

/// A blended mesh and how it came about.
struct MadeBlendTin {
    blend::FusedTin fused;
    std::string crs;
    PatchPlace place = PatchPlace::given;
    Vec2 at; ///< [m] the middle of the patch's box
};

/// Reads two meshes and pastes the one into the other: moved, turned and scaled, then fuse_tin.
/// \param params files. Without a place the patch stays at its own coordinates, bit for bit where it is neither turned
/// nor scaled; where its box does not meet the target's it comes into the middle of the target's box
/// \return the mesh, and what was done
/// \throws BadInput as read_tin and fuse_tin do, meshes in two different CRS
MadeBlendTin make_blend_tin(MakeBlendTinParams const& params, Run const& run = {});

} // namespace thalweg::pipeline
