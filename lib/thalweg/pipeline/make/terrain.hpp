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

/// How a solver ended.
struct SolverStory {
    std::int64_t iterations = 0;
    double residual = 0.0; ///< relative
};

/// Statistics of a patch.
struct PatchStory {
    std::int64_t cells = 0;  ///< replaced cells
    std::int64_t kept = 0;   ///< cells under it that rivers keep
    double seam_max_m = 0.0; ///< as blend::Pasted
    double seam_rms_m = 0.0;
};

/// Volumes changed by hydrological conditioning.
struct DrainStory {
    flow::DemChange banks;
    flow::DemChange depressions;
};

/// Statistics of a terrain in equilibrium with its rivers.
struct EquilibriumStory {
    surface::Edge edge = surface::Edge::open; ///< boundary condition, from recipe, mask or sea
    bool gave_way = false;            ///< true if the file's heights were relaxed because fixed ones needed walls
    std::int64_t channel_cells = 0;   ///< cells of rivers
    std::int64_t shortened_cells = 0; ///< of removed perched tips
    std::int64_t walled_cells = 0;    ///< of rivers whose prescribed heights need walls
    double max_lowered_m = 0.0;       ///< soft: below the prescribed heights
    double p95_lowered_m = 0.0;
    double rise = 0.0; ///< as surface::EquilibriumTerrain, like the following
    bool in_region = false;
    std::vector<surface::RegionInflow> inflows;
    std::int64_t side_valleys = 0; ///< arcs grown by the terrain, if requested
    std::int64_t side_valleys_left_out = 0;
};

/// Parameters of fractal detail, as used.
struct DetailStory {
    double hurst = 0.0;
    double sigma = 0.0; ///< as fractal::MidpointParams
};

/// A surface, its rivers, and its flow.
struct Terrain {
    Grid grid;
    Mask land;               ///< as Rivers
    ElevatedNetwork network; ///< without perched tips, with side valleys grown by the terrain
    NetworkOrders orders;
    network::StreamCounts streams; ///< side branches, as drawn
    network::RiverTypes types;     ///< by arc; empty: rivers have no types
    Valley valley;
    std::optional<surface::Dilated> surface;       ///< none if the recipe requests rivers alone
    std::optional<flow::FlowField> drainage;       ///< of the surface
    RidgeLines ridges;                             ///< between streams, if requested
    Channels channels;                             ///< of rivers in equilibrium with the terrain
    std::int64_t lakes = 0;                        ///< inserted into the channels
    std::optional<EquilibriumStory> equilibrium;   ///< of terrain in equilibrium
    std::optional<SolverStory> diffusion;          ///< statistics of the solver, if the surface was diffused
    std::optional<DetailStory> detail;             ///< if it has fractal detail
    std::vector<PatchStory> patches;               ///< in the recipe's order
    std::optional<DrainStory> drained;             ///< if the recipe requests conditioning
    std::optional<Tin> tin;                        ///< of rivers and points, if the terrain is drawn over one
    std::optional<fractal::MatchedDem> projection; ///< result of matching statistics; its dem is moved to surface
    /// [cells] size below which forms had to be taken from a Gaussian terrain to match them; 0: none
    double fine_forms_cells = 0.0;
    std::vector<Finding> notes;    ///< on changes to rivers
    std::vector<Check> checks;     ///< of the recipe's targets for the surface
    std::vector<Finding> findings; ///< of these checks
    Timings timings_s;
};

/// Makes the terrain of a plan around its rivers; or from statistics and points alone if it has none.
/// \param plan of the terrain
/// \param rivers made from the plan by make_rivers()
/// \return the same terrain for the same plan and rivers, with any Run
Terrain make_terrain(Plan const& plan, Rivers const& rivers, Run const& run = {});

} // namespace thalweg::pipeline
