// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/make/blend_into.hpp>

namespace thalweg::pipeline {

/// Reads two DEMs and sets a patch of the one into the other: place_patch, then paste.
/// \param params files
/// \param run progress, log, stop token and number of threads
/// \return as the stages do. A source in another CRS or with other cells is warped first, a window cut out of it
/// before: into the target's CRS where both lie on the same part of the earth; else it is measured in its own CRS or,
/// where that is not in metres, in its UTM zone. Of lines to keep those parts count that cross the target.
/// \throws BadParameter
/// \throws BadInput as the stages and doors do, also when keep is neither a raster nor lines, none of whose cells are
/// the target's, or a target in degrees is asked to take a turned patch
/// \throws NotConverged
/// \throws IoError
/// \throws Cancelled
MadeBlend make_blend(MakeBlendParams const& params, Run const& run = {});

} // namespace thalweg::pipeline
