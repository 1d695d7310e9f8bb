// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/measure/drainage/certificate.hpp>
#include <thalweg/measure/relief/hypsometry.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/pipeline/make/given.hpp>
#include <thalweg/pipeline/make/laws.hpp>
#include <thalweg/pipeline/make/relief.hpp>
#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/plan/plan.hpp>

namespace thalweg::pipeline {

/// Contributing areas [m2] by cell; NaN: no data.
struct WaterAreas {
    Raster<double> d8;
    Raster<double> dinf;
};

/// Measures of terrain and rivers, and the recipe's checks.
struct Assessment {
    std::optional<GivenLength> given;          ///< if rivers are read from lines
    std::optional<GivenHeights> given_heights; ///< if the DEM should have the lines' heights
    std::optional<GivenAreas> given_areas;     ///< if the lines have areas and the terrain drains
    flow::ContributingAreas areas;             ///< of the arcs
    RiverLaws laws;
    std::vector<NodeId> sinks;                     ///< where rivers are meant to end inland
    std::optional<measure::Statistics> statistics; ///< of the surface, like the others
    std::optional<measure::Hypsometry> hypsometry;
    std::optional<TerrainRelief> relief; ///< with the rivers
    std::int64_t pits = 0;               ///< cells in depressions
    double pit_volume_m3 = 0.0;
    std::optional<measure::ExtractedRidges> surface_ridges; ///< compared with the requested ridges
    std::optional<measure::Certificate> certificate;        ///< of rivers and surface, if both exist
    std::optional<flow::Catchments> catchments;             ///< of the arcs, if requested
    std::optional<WaterAreas> water_areas;                  ///< if requested
    std::vector<Check> checks;
    std::vector<Finding> findings; ///< of the checks
    Timings timings_s;

    /// \return whether every check is ok
    bool passed() const;
};

/// Measures and checks terrain and rivers.
/// \param plan of both
/// \param rivers made from the plan
/// \param terrain made from plan and rivers
/// \return measures and checks
Assessment assess(Plan const& plan, Rivers const& rivers, Terrain const& terrain, Run const& run = {});

} // namespace thalweg::pipeline
