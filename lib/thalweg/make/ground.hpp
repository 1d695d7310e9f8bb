// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/strata/strata.hpp>

namespace thalweg::make {

/// Over triangles of rivers, ridges and points, or of points alone.
struct OverTriangles {};

/// Of a DEM, as surface.source names it.
struct OfDem {};

/// At random, with the statistics that the recipe asks for.
struct OfNumbers {};

/// By regression through points.
struct ByRegression {};

/// By dilation of the valley, as surface::DilatedDem.
struct ByDilation {
    std::vector<double> increments = {}; ///< [m] of each level
    std::int64_t levels = 0;
    double rise_m = 0.0;
    double flat_share = 0.0; ///< [0, 1]
};

/// By diffusion from rivers, ridges and points.
struct ByDiffusion {
    std::int64_t iterations = 0;
    double residual = 0.0; ///< relative
};

/// What terrain took from the DEM of surface.like.
struct LikeStatistics {
    double mean_slope_deg = 0.0;
    double wanted_correlation = 0.0; ///< of unit gradients, lag_m apart; NaN: not known
    double lag_m = 0.0;
    double roughness = 0.0;   ///< found for it
    double correlation = 0.0; ///< met; NaN: not sought
};

/// In equilibrium of uplift and erosion with its rivers, as surface::EquilibriumTerrain.
struct Equilibrium {
    surface::Edge edge = surface::Edge::open; ///< of the terrain, by recipe, mask or sea
    std::int64_t channel_cells = 0;           ///< in which rivers run
    std::int64_t shortened_cells = 0;         ///< of perched tips that were cut
    std::int64_t graded_heads = 0;            ///< of these tips, those that would have had to lie in trenches
    std::int64_t walled_cells = 0;            ///< of rivers whose input heights only walls hold up
    double max_lowered_m = 0.0;               ///< soft: below the input heights
    double p95_lowered_m = 0.0;
    double rise = 0.0;
    double steepness = 0.0;      ///< [m^0.9] normalised, of the main stems; NaN: not graded
    double strata_shift_m = 0.0; ///< as surface::EquilibriumTerrain
    std::int64_t held_back = 0;  ///< likewise
    bool in_region = false;
    std::vector<surface::RegionInflow> inflows = {};
    std::optional<LikeStatistics> like = {}; ///< where surface.like is set
};

/// In equilibrium with rivers whose heights their file has: what these told of the terrain, as surface::RebuiltTerrain.
struct Rebuilt : Equilibrium {
    double source_km2 = 0.0; ///< as surface::RiverSurvey
    double river_spacing_m = 0.0;
    double river_concavity = 0.0;
    double smooth_slope_deg = 0.0;
};

/// How a surface was made; nothing: there is none.
using HowMade = std::variant<std::monostate, OverTriangles, OfDem, OfNumbers, ByRegression, ByDilation, ByDiffusion,
                             Equilibrium, Rebuilt>;

/// Parameters of fractal detail, as used.
struct DetailStatistics {
    double hurst = 0.0; ///< 0: there is no detail
    double sigma = 0.0; ///< as fractal::MidpointParams
};

/// How a surface was brought to the statistics that the recipe asks for.
struct MatchedStatistics {
    fractal::MatchedDem projection = {}; ///< its DEM is that of the ground
    double fine_forms_cells = 0.0; ///< [cells] below which forms come from a Gaussian surface to meet them; 0: none
};

/// Statistics of a patch.
struct PatchStatistics {
    std::int64_t cells = 0;  ///< replaced cells
    std::int64_t kept = 0;   ///< cells under it that rivers keep
    double seam_max_m = 0.0; ///< as blend::PastedDem
    double seam_rms_m = 0.0;
};

/// A surface, how it was made, and what it was drawn through.
struct Ground {
    Raster<float> dem = {}; ///< [m] without cells where the recipe asks for rivers alone
    HowMade how = {};
    Mask land = {}; ///< as Planform; without cells where the surface is that of a DEM
    DetailStatistics detail = {};
    std::optional<MatchedStatistics> matched = {}; ///< where the recipe asks for statistics
    RidgeLines ridges = {};                        ///< between streams and given, where they are asked for
    Tin tin = {};                                  ///< of rivers and points; without vertices where none is asked for
    std::vector<PatchStatistics> patches = {};     ///< in the recipe's order

    /// \return how it is in equilibrium with its rivers; null: it is not
    Equilibrium const* equilibrium() const;
    /// \return how it was dilated; without increments: it was not
    ByDilation const& dilated() const;
};

/// Whether a terrain's heights follow from nothing that was given: around rivers of a file without heights, with
/// neither surface.relief nor surface.like.
/// \param recipe resolved
bool heights_are_invented(recipe::Recipe const& recipe);

/// What files and pictures of such a terrain say.
inline constexpr char const* invented_heights = "heights are invented: surface.relief or surface.like give others";

/// How layers of rock lie in a grid.
/// \param recipe with a surface in equilibrium
/// \return without layers where the recipe has none
surface::Strata strata_of(recipe::Recipe const& recipe, Grid const& grid);

/// Whether the ground was made in layers of rock.
bool has_layers(recipe::Recipe const& recipe, Ground const& ground);

/// The bed of the layers of rock of terrain that has some.
/// \return [m] by cell, as surface::bed_heights()
Raster<float> bed_of(recipe::Recipe const& recipe, Ground const& ground, Grid const& grid, Run const& run = {});

/// The uplift of terrain in equilibrium: of the recipe's raster times its pattern.
/// \param recipe with a surface in equilibrium
/// \return > 0 by cell, only ratios count; without cells where uplift is the same everywhere
/// \throws Error where the raster cannot be read or does not cover the grid
Raster<float> relative_uplift(recipe::Recipe const& recipe, Grid const& grid, Run const& run = {});

} // namespace thalweg::make
