// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/make/against.hpp>
#include <thalweg/make/features.hpp>
#include <thalweg/make/given.hpp>
#include <thalweg/make/laws.hpp>
#include <thalweg/make/relief.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/measure/drainage/certificate.hpp>
#include <thalweg/measure/relief/hypsometry.hpp>
#include <thalweg/measure/relief/statistics.hpp>

namespace thalweg::make {

/// Contributing areas [m2] by cell; NaN: no data.
struct WaterAreas {
    Raster<double> d8;
    Raster<double> dinf;
};

/// What is measured of a surface with its rivers.
struct SurfaceMeasures {
    std::optional<measure::Statistics> statistics = {}; ///< with hypsometry and relief: where there is a surface
    std::optional<measure::Hypsometry> hypsometry = {};
    std::optional<TerrainRelief> relief = {};
    std::int64_t pits = 0; ///< cells that lie in depressions
    double pit_volume_m3 = 0.0;
    std::vector<NodeId> sinks = {};                              ///< where rivers end inland, as the recipe asks
    std::optional<measure::ExtractedRidges> surface_ridges = {}; ///< beside the ridges asked for
    std::optional<measure::Certificate> certificate = {};        ///< of rivers and surface, where both are there
    Raster<std::uint8_t> layers =
        {}; ///< of rock at the surface, as surface::layers_at(); without cells: there are none
    std::vector<double> layer_shares = {};           ///< by layer: of the surface
    std::optional<flow::Catchments> catchments = {}; ///< of the arcs, where they are asked for
    std::optional<WaterAreas> water_areas = {};      ///< where they are asked for
    RiverLaws laws = {};
};

/// What is measured of surface and rivers, and whether they are what the recipe sets.
struct Assessment : SurfaceMeasures {
    std::optional<GivenLength> given = {};            ///< where rivers are read from lines
    std::optional<GivenHeights> given_heights = {};   ///< where the DEM is to have heights of these
    std::optional<GivenFeatures> given_features = {}; ///< where the recipe names points or ridges between rivers
    std::optional<Against> against = {};              ///< where the recipe names a DEM to compare with
    std::optional<GivenAreas> given_areas = {};       ///< where the lines have areas and the terrain drains
    std::vector<Check> checks = {};
    std::vector<Finding> findings = {}; ///< of the checks, and what they warn of
    Timings timings_s = {};

    /// \return whether every check is ok
    bool passed() const;
};

} // namespace thalweg::make
