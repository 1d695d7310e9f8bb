// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/make_blend.hpp>

#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>

namespace thalweg::pipeline {

MadeBlend make_blend(MakeBlendParams const& params, Run const& run) {
    Raster<float> const target = io::read_dem(params.target, {.nodata = params.nodata}, run);
    return blend_into(target, read_kept(params.keep, target.grid(), run), params, run);
}

} // namespace thalweg::pipeline
