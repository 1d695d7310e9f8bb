// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/make/rivers.hpp>
#include <thalweg/make/valley_cells.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::make {

/// Rivers with heights that do not follow from a surface.
struct RaisedRivers {
    ElevatedNetwork network = {};
    ValleyCells valley = {};
    HeightsStatistics statistics = {};
    std::optional<flow::ContributingAreas> areas = {}; ///< by the nearest river, where the heights follow from them
    std::vector<Finding> findings = {};                ///< on rivers that meet in their cells, on lakes
    std::int64_t lakes = 0;
    Channels channels = {}; ///< with the lakes; empty without
};

/// Assigns heights to rivers by the recipe, or those of their file.
/// dem: of surface.source
RaisedRivers raise_rivers(recipe::Recipe const& recipe, Raster<float> const& dem, Planform const& planform,
                          StageLog& stage_log, Run const& run);

} // namespace thalweg::make
