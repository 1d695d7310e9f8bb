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
#include <thalweg/flow/condition.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/pipeline/make/rivers.hpp>
#include <thalweg/pipeline/plan/plan.hpp>
#include <thalweg/surface/dilation/dilation.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

namespace thalweg::pipeline {

/// How a solver came to its end.
struct SolverStory {
    std::int64_t iterations = 0;
    double residual = 0.0; ///< relative
};

/// What became of a patch.
struct PatchStory {
    std::int64_t cells = 0;  ///< that it replaced
    std::int64_t kept = 0;   ///< under it that rivers keep
    double seam_max_m = 0.0; ///< as blend::Pasted
    double seam_rms_m = 0.0;
};

/// What it took to make the land drain.
struct DrainStory {
    flow::DemChange banks;
    flow::DemChange depressions;
};

/// How a land came into equilibrium with its rivers.
struct EquilibriumStory {
    surface::Edge edge = surface::Edge::open; ///< of the land, by recipe, mask or sea
    bool gave_way = false;            ///< heights of the rivers' file: lowered where they would have needed walls
    std::int64_t channel_cells = 0;   ///< in which rivers run
    std::int64_t shortened_cells = 0; ///< of perched tips that are rivers no more
    std::int64_t walled_cells = 0;    ///< of rivers whose given heights only walls hold up
    double max_lowered_m = 0.0;       ///< soft: below the given heights
    double p95_lowered_m = 0.0;
    double rise = 0.0; ///< as surface::EquilibriumTerrain, and what follows
    bool in_region = false;
    std::vector<surface::RegionInflow> inflows;
    std::int64_t side_valleys = 0; ///< arcs that the land has grown, where they are asked for
    std::int64_t side_valleys_left_out = 0;
};

/// Of fractal detail, as it was made.
struct DetailStory {
    double hurst = 0.0;
    double sigma = 0.0; ///< as fractal::MidpointParams
};

/// A surface, the rivers as it has them, and how water flows over it.
struct Terrain {
    Grid grid;
    Mask land;               ///< as Rivers
    ElevatedNetwork network; ///< without tips that would stand perched, with the side valleys that the land has grown
    NetworkOrders orders;
    network::StreamCounts streams; ///< side branches, as drawn
    network::RiverTypes types;     ///< by arc, where rivers have types; else empty
    Valley valley;
    std::optional<surface::Dilated> surface;       ///< none where the recipe wants rivers alone
    std::optional<flow::FlowField> drainage;       ///< of the surface
    RidgeLines ridges;                             ///< between streams, where they are asked for
    Channels channels;                             ///< of rivers with which the land is in equilibrium
    std::int64_t lakes = 0;                        ///< laid into them
    std::optional<EquilibriumStory> equilibrium;   ///< of a land that is
    std::optional<SolverStory> diffusion;          ///< how the surface was solved for, where it was diffused
    std::optional<DetailStory> detail;             ///< where it has fractal detail
    std::vector<PatchStory> patches;               ///< in the recipe's order
    std::optional<DrainStory> drained;             ///< where the recipe wants the land to drain
    std::optional<Tin> tin;                        ///< of rivers and points, where the land is drawn over one
    std::optional<fractal::MatchedDem> projection; ///< how the statistics came out; its dem is moved to surface
    double fine_forms_cells = 0.0; ///< [cells] below which forms had to come from a Gaussian land to meet them; 0: none
    std::vector<Finding> notes;    ///< what became of rivers
    std::vector<Check> checks;     ///< of the recipe's request of the surface
    std::vector<Finding> findings; ///< of these
    Timings timings_s;
};

/// Draws the terrain of a plan around its rivers; or from numbers and points alone where it has none.
/// \param rivers those of the plan; make_rivers()
/// \return the same terrain for the same plan and rivers, whatever the Run.
Terrain make_terrain(Plan const& plan, Rivers const& rivers, Run const& run = {});

} // namespace thalweg::pipeline
