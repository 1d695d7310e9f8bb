// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/features.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/condition.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/make/rivers.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/surface/dilation/dilation.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

namespace thalweg::make {

/// How a solver ended.
struct SolverStatistics {
    std::int64_t iterations = 0;
    double residual = 0.0; ///< relative
};

/// Statistics of a patch.
struct PatchStatistics {
    std::int64_t cells = 0;  ///< replaced cells
    std::int64_t kept = 0;   ///< cells under it that rivers keep
    double seam_max_m = 0.0; ///< as blend::Pasted
    double seam_rms_m = 0.0;
};

/// Volumes changed by hydrological conditioning.
struct ConditioningChanges {
    flow::DemChange banks;
    flow::DemChange depressions;
};

/// What terrain took from the DEM of surface.like.
struct LikeStatistics {
    double mean_slope_deg = 0.0;
    double wanted_correlation = 0.0; ///< of unit gradients, lag_m apart; NaN: not known
    double lag_m = 0.0;
    double roughness = 0.0;   ///< found for it
    double correlation = 0.0; ///< met; NaN: not sought
};

/// What rivers with heights of a file told of the terrain, as surface::RebuiltTerrain.
struct RebuildStatistics {
    double source_km2 = 0.0; ///< as surface::RiverSurvey
    double river_spacing_m = 0.0;
    double river_concavity = 0.0;
    double smooth_slope_deg = 0.0;
};

/// How terrain came into equilibrium with its rivers.
struct EquilibriumStatistics {
    surface::Edge edge = surface::Edge::open; ///< of the terrain, by recipe, mask or sea
    std::int64_t channel_cells = 0;           ///< in which rivers run
    std::int64_t shortened_cells = 0;         ///< of perched tips that were cut
    std::int64_t walled_cells = 0;            ///< of rivers whose input heights only walls hold up
    double max_lowered_m = 0.0;               ///< soft: below the input heights
    double p95_lowered_m = 0.0;
    double rise = 0.0; ///< as surface::EquilibriumTerrain, like the following
    bool in_region = false;
    std::vector<surface::RegionInflow> inflows;
    std::optional<RebuildStatistics> rebuilt; ///< where heights of a file are kept
    std::optional<LikeStatistics> like;       ///< where surface.like is set
};

/// Arcs made of valleys that the terrain has beside its rivers.
struct SideValleysStatistics {
    std::int64_t grown = 0;
    std::int64_t left_out = 0;
};

/// Parameters of fractal detail, as used.
struct DetailStatistics {
    double hurst = 0.0;
    double sigma = 0.0; ///< as fractal::MidpointParams
};

/// A surface, the rivers with the heights that they have in it, and the water that drains over it.
struct Terrain {
    Grid grid;
    Mask land;     ///< as Planform; without cells where the surface is a raster
    Rivers rivers; ///< without perched tips, with side valleys where they are asked for; without arcs where the recipe
                   ///< has no [network]
    Valley valley; ///< the cells under them
    flow::ContributingAreas areas;                    ///< of their arcs: by the drainage, or by the nearest river
    std::optional<surface::Dilated> surface;          ///< none where the recipe asks for rivers alone
    std::optional<flow::FlowField> drainage;          ///< of the surface
    RidgeLines ridges;                                ///< between streams and given, where they are asked for
    std::optional<Tin> tin;                           ///< of rivers and points, where the surface is drawn over one
    Channels channels;                                ///< of rivers with which the surface is in equilibrium
    std::int64_t lakes = 0;                           ///< in them
    HeightsStatistics heights;                        ///< of rivers whose heights do not follow from the surface
    std::optional<EquilibriumStatistics> equilibrium; ///< where the surface is
    SideValleysStatistics side_valleys;               ///< where they are asked for
    std::optional<SolverStatistics> diffusion;        ///< how the surface was solved for, where it was diffused
    std::optional<DetailStatistics> detail;           ///< where it has fractal detail
    std::vector<PatchStatistics> patches;             ///< in the recipe's order
    std::optional<ConditioningChanges> drained;       ///< where the surface was conditioned hydrologically
    std::optional<fractal::MatchedDem> projection;    ///< how the statistics came out; its dem is moved to surface
    double fine_forms_cells = 0.0; ///< [cells] below which forms come from a Gaussian surface to meet them; 0: none
    std::vector<Check> checks;     ///< of what the recipe asks of the surface
    std::vector<Finding> findings; ///< of these, and on rivers and the surface
    Timings timings_s;
};

/// Draws the terrain of a plan around its rivers; or from numbers and points alone where it has none.
/// \param planform the rivers of the plan; make_planform()
/// \return the same terrain for the same plan and rivers, whatever the Run.
Terrain make_terrain(recipe::Plan const& plan, Planform const& planform, Run const& run = {});

} // namespace thalweg::make
