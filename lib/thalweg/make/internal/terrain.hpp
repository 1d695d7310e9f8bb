// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/skeleton/scatter.hpp>

namespace thalweg::make {

/// Rivers with heights that do not follow from a surface.
struct RaisedRivers {
    ElevatedNetwork network;
    Valley valley;
    HeightsStatistics statistics;
    std::optional<flow::ContributingAreas> areas; ///< by the nearest river, where the heights follow from them
    std::vector<Finding> findings = {};           ///< on rivers that meet in their cells, on lakes
    std::int64_t lakes = 0;
    Channels channels = {}; ///< with the lakes; empty without
};

/// Assigns heights to rivers by the recipe, or those of their file.
RaisedRivers raise_rivers(recipe::Plan const& plan, Planform const& planform, StageLog& stage_log, Run const& run);

/// The check points_missing: random points that found no room, with findings on room.
Check points_missing(skeleton::Scattered const& points, recipe::SkeletonRecipe const& wanted, StageLog& stage_log);

/// A surface without rivers (paper 001).
struct SurfaceAlone {
    Raster<float> dem = {};
    std::optional<Tin> tin = {};
    std::optional<SolverStatistics> diffusion = {};
    std::optional<DetailStatistics> detail = {};
    std::optional<fractal::MatchedDem> projection = {};
    double fine_forms_cells = 0.0; ///< as Terrain
    std::vector<Check> checks = {};
};

/// A random surface, or one through points, with fractal detail and the statistics that are asked for.
SurfaceAlone draw_without_rivers(recipe::Plan const& plan, StageLog& stage_log, Run const& run);

/// A DEM with fractal detail, and how that was made.
struct DetailedTerrain {
    DetailStatistics statistics;
    Raster<float> dem;
};

/// Fractal detail of a plan on a plain.
DetailedTerrain detail_alone(recipe::Plan const& plan, Grid const& grid, Run const& run);

/// A surface in equilibrium with its rivers.
struct EquilibriumResult {
    Rivers rivers; ///< without perched tips, with the heights of the surface
    Valley valley;
    Raster<float> dem;
    Channels channels;
    std::int64_t lakes = 0;
    HeightsStatistics heights;
    EquilibriumStatistics statistics;
    std::vector<Check> checks; ///< of what the recipe asks of the surface
};

/// Draws the surface around the planned rivers and cuts tips that would be perched. Heights that were taken because
/// the lines have them give way where they would need walls.
EquilibriumResult draw_in_equilibrium(recipe::Plan const& plan, Planform const& planform, StageLog& stage_log,
                                      Run const& run);

/// Rivers with the side valleys of a surface in equilibrium as arcs.
struct WithSideValleys {
    Rivers rivers;
    Valley valley;
    SideValleysStatistics statistics;
};

/// \param dem,drainage the surface as it drains
WithSideValleys with_side_valleys(recipe::Plan const& plan, Rivers rivers, Valley valley, Channels const& channels,
                                  Raster<float> const& dem, flow::FlowField const& drainage, StageLog& stage_log,
                                  Run const& run);

} // namespace thalweg::make
