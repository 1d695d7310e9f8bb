// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/measure/relief/relief.hpp>

namespace thalweg::pipeline {

/// The relief of a land, and of the rivers drawn on it.
struct TerrainRelief {
    measure::Relief land;
    std::optional<std::int64_t> perched; ///< river cells that stand above their surroundings, where rivers are drawn
};

/// \param dem [m] heights by cell; NaN: no data
/// \return relief of any DEM, drained for it, with the side that its cells have on the ground (io::ground_cell): a
/// geographic one's too, though its cells count as squares.
/// \throws Error as measure::statistics and ground_cell do
TerrainRelief relief_of_dem(Raster<float> const& dem, Run const& run = {});

struct Plan;
struct Terrain;

/// Relief of a surface with its statistics.
/// \param plan the plan of the terrain
/// \param terrain one with a surface
/// \return perched where it has rivers: by the mean slope that the plan asks for, else that of the land.
TerrainRelief relief_of_terrain(Plan const& plan, Terrain const& terrain, measure::Statistics const& statistics,
                                Run const& run = {});

/// A figure as report.json and the page tell it.
struct ReliefRow {
    std::string_view key;
    std::string_view name;
    std::string_view unit;
    std::optional<double> value;               ///< none where the land is too small to tell
    std::vector<double> beside;                ///< of the reference DEMs, in their order; empty where they have none
    std::optional<measure::ReliefRange> range; ///< none where nothing can be said
    bool ok() const { return !value || !range || (*value >= range->low && *value <= range->high); }
};

/// \return the figures one by one: those of measure::relief_metrics, the distance of the geomorphons from the mean of
/// the reference DEMs, and perched cells where there are rivers.
std::vector<ReliefRow> relief_rows(TerrainRelief const& relief);

/// \param rows figures
/// \param rivers_of_file whether rivers are drawn as a file has them: their straight runs say nothing of the land
/// \return in words what of texture and forms leaves the range of the reference DEMs; "" for nothing.
std::string unlike_land(std::vector<ReliefRow> const& rows, bool rivers_of_file);

/// \return all of it beside the reference DEMs, as one JSON object: dem.relief in report.json, and what the page draws.
std::string relief_json(TerrainRelief const& relief);

} // namespace thalweg::pipeline
