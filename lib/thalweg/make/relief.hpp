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
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::make {

/// The relief of a terrain, and of the rivers drawn on it.
struct TerrainRelief {
    measure::Relief land;
    std::optional<std::int64_t> perched; ///< river cells above their surroundings; nothing: no rivers
};

/// Gives a DEM's cells their size on the ground (io::ground_cell): geographic DEMs can be measured so, though their
/// cells count as squares.
/// \throws Error as ground_cell
Raster<float> on_ground(Raster<float> const& dem);

/// Computes the relief of a DEM on the ground.
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM
/// \return without perched cells
/// \throws Error as measure::statistics
TerrainRelief relief_of_dem(Raster<float> const& dem, flow::FlowField const& drainage, Run const& run = {});

/// Computes the relief of any DEM and routes flow over it, on_ground().
/// \param dem [m] by cell; NaN: no data
/// \return without perched cells
/// \throws Error as measure::statistics and ground_cell
TerrainRelief relief_of_dem(Raster<float> const& dem, Run const& run = {});

struct Terrain;

/// Computes the relief of a terrain's surface.
/// \param recipe of the terrain
/// \param terrain with a surface
/// \param statistics of the surface
/// \return with perched cells if it has rivers, by the mean slope that it sets, else of the terrain
TerrainRelief relief_of_terrain(recipe::Recipe const& recipe, Terrain const& terrain,
                                measure::Statistics const& statistics, Run const& run = {});

/// One index of relief, for report.json and the page.
struct ReliefRow {
    std::string_view key;
    std::string_view name;
    std::string_view unit;
    std::optional<double> value;               ///< [unit] nothing: the terrain is too small
    std::vector<double> beside;                ///< [unit] of the reference DEMs, in order; empty: they have none
    std::optional<measure::ReliefRange> range; ///< nothing: unknown
    bool ok() const { return !value || !range || (*value >= range->low && *value <= range->high); }
};

/// Lists the indices of relief: those of measure::relief_metrics, the distance of the geomorphons from the mean of the
/// reference DEMs, and perched cells if there are rivers.
/// \param relief of a terrain
/// \return in a fixed order
std::vector<ReliefRow> relief_rows(TerrainRelief const& relief);

/// What a terrain has that real land does not, and what changes that; "": nothing.
struct UnlikeRealLand {
    std::string text;
    std::string remedy;
};

/// What of a terrain is compared with real land.
struct ComparedRelief {
    bool has_texture = true;     ///< texture and forms, which randomness dominates on few cells
    bool rivers_of_file = false; ///< drawn as in a file, so that their straight parts are not the terrain's
};

/// \internal
/// Describes in words the indices of texture, forms, canals and walls outside the range of the reference DEMs.
/// \param rows indices
UnlikeRealLand unlike_real_land(std::vector<ReliefRow> const& rows, ComparedRelief const& compared);

/// \internal
/// Formats the relief with the reference DEMs as one JSON object: dem.relief in report.json, and the data of the page's
/// diagrams.
/// \param relief of a terrain
/// \return JSON
std::string relief_json(TerrainRelief const& relief);

} // namespace thalweg::make
