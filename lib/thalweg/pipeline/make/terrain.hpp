// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/ridge_lines.hpp>
#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/core/valley.hpp>
#include <thalweg/flow/catchments/areas.hpp>
#include <thalweg/flow/catchments/catchments.hpp>
#include <thalweg/flow/conditioning/dem_change.hpp>
#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/measure/drainage/certificate.hpp>
#include <thalweg/measure/drainage/extract_ridges.hpp>
#include <thalweg/measure/relief/hypsometry.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/network/elevation/assign_types.hpp>
#include <thalweg/network/order/count_streams.hpp>
#include <thalweg/pipeline/make/assess.hpp>
#include <thalweg/pipeline/make/drawn_terrain.hpp>
#include <thalweg/pipeline/make/laws.hpp>
#include <thalweg/pipeline/make/network_story.hpp>
#include <thalweg/pipeline/make/relief.hpp>
#include <thalweg/pipeline/make/river_file.hpp>
#include <thalweg/pipeline/plan/timings.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// A terrain with all that led to it.
struct Terrain {
    Recipe recipe; ///< every default resolved: made again, it gives the same terrain
    Grid grid;
    ElevatedNetwork network;
    RiverFile file; ///< of which the rivers are
    Mask land;      ///< 0: sea, which has no heights; without cells: all is land
    NetworkOrders orders;
    network::StreamCounts streams; ///< side branches, as drawn
    network::RiverTypes types;     ///< by arc, where rivers have types; else empty
    flow::ContributingAreas areas;
    RiverLaws laws;
    Valley valley;
    RidgeLines ridges;                                      ///< between streams, where they are asked for
    std::optional<measure::ExtractedRidges> surface_ridges; ///< those of the surface beside them
    std::optional<surface::Dilated> surface;
    Channels channels;                             ///< of rivers with which the land is in equilibrium
    std::int64_t lakes = 0;                        ///< laid into them
    std::vector<NodeId> sinks;                     ///< where rivers end inland, as they were asked to
    std::optional<EquilibriumStory> equilibrium;   ///< of a land that is
    std::optional<SolverStory> diffusion;          ///< how the surface was solved for, where it was diffused
    std::vector<PatchStory> patches;               ///< in the recipe's order
    std::optional<DrainStory> drained;             ///< where the recipe wants the land to drain
    std::optional<Tin> tin;                        ///< of rivers and points, where the land is drawn over one
    std::optional<fractal::MatchedDem> projection; ///< how the statistics came out; its dem is moved to surface
    double fine_forms_cells = 0.0; ///< [cells] below which forms had to come from a Gaussian land to meet them; 0: none
    std::optional<measure::Statistics> statistics; ///< of the surface
    std::optional<measure::Hypsometry> hypsometry; ///< likewise
    std::optional<TerrainRelief> relief;           ///< likewise, with the rivers
    std::int64_t pits = 0;                         ///< cells of the surface that lie in depressions
    double pit_volume_m3 = 0.0;
    std::optional<measure::Certificate> certificate; ///< of rivers and surface, where both are there
    std::optional<flow::Catchments> catchments;      ///< of the arcs on the surface, where they are asked for
    std::optional<WaterAreas> water_areas;           ///< by cell of the surface, where they are asked for
    NetworkStory story;
    std::vector<Check> checks;
    std::vector<Finding> findings; ///< of the checks
    Timings timings_s;
    /// \return every check is ok
    bool passed() const;
};

/// Rivers, land and what is measured of them in one value.
/// \param rivers the rivers
/// \param drawn what was drawn
/// \param found measures and checks
/// \return the terrain
Terrain together(Rivers rivers, DrawnTerrain drawn, Assessment found);

/// Called with intermediates: "valley", "surface".
using Keep = std::function<void(std::string_view, Raster<float> const&)>;

/// From a recipe to a terrain: rivers first, then the land around them; or land from numbers and points alone.
/// \param recipe the recipe
/// \param run progress, log, stop token and number of threads
/// \param keep receives intermediate rasters
/// \return the same terrain for the same recipe, whatever the Run.
/// \throws BadParameter
/// \throws BadInput
/// \throws IoError
/// \throws Cancelled
Terrain make_terrain(Recipe const& recipe, Run const& run = {}, Keep const& keep = {});

} // namespace thalweg::pipeline
