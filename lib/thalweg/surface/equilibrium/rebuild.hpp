// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

// Idea: Rivers with heights tell more than their places: how steep they are tells how steep the
// land beside is. First the expected terrain is found: the equilibrium's levels with a low
// concavity and no noise, whose uplift follows the rivers' own steepness, grows along the flow path
// where a river would stand above the land beside it, and is scaled until the mean slope is the one
// that the sources suggest. Then the last three levels are solved again with side valleys and
// noise, held to the smooth terrain: uplift is corrected until blurred heights above rivers agree,
// and springs keep its divides. Two passes, because valleys cannot be known from rivers, and wrong
// ones would cost heights and divides.
// Source: ours: docs/decisions/0032-rebuild.md.
// Cost: two passes with the rounds of equilibrium.hpp, O(n) each; with a target slope or relief up
// to six solutions. All cores, but for the floods.
// Not for: rivers without heights (equilibrium.hpp); rills of a DEM of 1 to 5 m, plateaus, glacial
// land and plains below 5 degrees, where the slope of rivers says little: give mean_slope_deg there
// (doubts_of warns). Land beyond the grid is not known: all of it drains to the rivers.
// Example:
//     RebuiltTerrain const rebuilt = rebuild(drawn_channels, {}, {.mean_slope_deg = 20.0});
//     double const spacing_m = rebuilt.survey.spacing_m; // between rivers
//     Raster<float> const& dem_m = rebuilt.terrain.dem;
// More: docs/rebuild.md.

namespace thalweg::surface {

/// Options of rebuild().
struct RebuildParams {
    std::optional<double> mean_slope_deg; ///< (0, 60] of the terrain; none: from the rivers
    std::optional<double> relief_m;       ///< [m] > 0, highest minus lowest cell; replaces the mean slope
    double theta = 0.5;                   ///< [0.1, 0.9] concavity index of the valleys beside the rivers
    double hillslope_m = 15.0;            ///< [m] >= 0 length below which soil creep dominates
    double debris_area_m2 = 15'000.0;     ///< [m²] >= 0 drainage area below which debris flows cut
    double floor_width_km = 0.009;        ///< [km] [0, 1] half width of a valley floor where 1 km² drains
    double roughness = 0.5;               ///< [0, 1] standard deviation of log erodibility, as noise
    double longest_wave_m = 2000.0;       ///< [m] > 0 longest wavelength of that noise
    Edge edge = Edge::closed; ///< coast, mainland: the sea, at height 0, where the mask is 0; else terrain ends there
    std::uint64_t seed = 7;
};

/// What rivers with heights tell of the terrain beside them.
struct RiverSurvey {
    double spacing_m = 0.0;      ///< median distance of cells to the nearest river
    double concavity = 0.0;      ///< of the rivers: -d ln slope / d ln area, limited to 0.2 to 1.2
    double mean_slope_deg = 0.0; ///< of smooth terrain between them
    double source_km2 = 0.0;     ///< [km²] median area that drains to sources
    Raster<float> steepness;     ///< factor of uplift, from the rivers' own steepness to the power 1/2; about 1
};

/// Warns where rivers tell little of how steep the land between them is.
/// \return "rills" or "gentle_land", or nothing
std::vector<Finding> doubts_of(RiverSurvey const& survey);

/// The same rivers with a height in every cell.
/// \param rivers with some heights, which do not rise downstream; as rebuild()
/// \throws BadInput when no cell has a height
Channels with_heights(Channels rivers);

/// Surveys rivers with heights: areas by the nearest river cell, slopes along main stems over half a kilometre or the
/// rivers' spacing. Lakes do not count.
/// \pre heights fall towards the receivers
RiverSurvey survey_rivers(Channels const& rivers, Run const& run = {});

/// What rebuild() returns.
struct RebuiltTerrain {
    EquilibriumTerrain terrain;
    RiverSurvey survey;
    double smooth_slope_deg = 0.0; ///< mean slope of the smooth terrain
};

/// Builds terrain between rivers with known heights: first smooth terrain, in equilibrium by a low concavity index,
/// whose uplift follows the rivers' own steepness, is raised where a river would stand above the land beside it, and
/// has the mean slope wanted on every level; then terrain with side valleys and noise on the last levels, held to the
/// heights above rivers and to the divides of the smooth one.
/// \param rivers at least one has a height. Between known heights rivers fall as their areas require, above the highest
/// by the median steepness of known ones; a river without any ends at the height of the nearest known cell
/// \throws BadParameter, BadInput as equilibrium()
RebuiltTerrain rebuild(Channels const& rivers, EquilibriumFields const& fields = {}, RebuildParams const& params = {},
                       Run const& run = {});

} // namespace thalweg::surface
