// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/flow/condition.hpp>
#include <thalweg/fractal/midpoint.hpp>
#include <thalweg/skeleton/regress.hpp>
#include <thalweg/skeleton/scatter.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/dilation/dilation.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/uplift/uplift_pattern.hpp>

namespace thalweg::pipeline {

/// What a land in equilibrium is like, beside surface.relief and network.concavity.
struct EquilibriumRecipe {
    std::optional<double> mean_slope_deg; ///< none: 25, where no relief is asked
    double hillslope_m = 15.0;            ///< [m] this and what follows as surface::EquilibriumParams
    double debris_area_km2 = 0.045;
    double floor_width = 0.0425; ///< [0, 1] 0.0425: floors 18 m wide where 1 km² drains, in proportion
    double roughness = 0.22;
    double longest_wave_m = 10'800.0;
    double grain = 5.0;
    std::optional<double> strike_deg;
    std::optional<surface::Edge> edge; ///< none: mainland by coastlines, coast by other sea, else open
    std::optional<double> region;      ///< none: 3 for grown rivers, 1 for those of a file
    std::string uplift;                ///< raster on the grid; "" for none
    std::optional<surface::UpliftPattern> uplift_pattern; ///< none: uplift is the same everywhere, but for the raster
    double uplift_contrast = 4.0;
    double uplift_wave_m = 12'000.0;
    std::string erodibility; ///< raster on the grid, or polygons with a field of that name; "" for none
    std::string lakes;       ///< polygons; "" for none
    double lake_share = 0.0; ///< [0, 1] of the reaches with enough water, that run through a lake
};

enum class Method : std::uint8_t { equilibrium, dilate, diffuse, tin, regress };

enum class Base : std::uint8_t { harmonic, paper, tin };

enum class Interpolation : std::uint8_t { linear, natural };

/// The keys of section [surface] of a recipe.
struct SurfaceRecipe {
    Method method = Method::equilibrium;
    EquilibriumRecipe equilibrium;
    Base base = Base::harmonic;
    surface::DilateParams dilate;
    surface::DiffuseParams diffuse;
    std::string mask; ///< raster on the grid: cells with 0 or no data are left out; "" for none
    Interpolation interpolation = Interpolation::linear; ///< of a TIN
    std::optional<double> tolerance;                     ///< (0, 0.1] of a solution; none: that of each method
    skeleton::RegressParams regress;
    std::optional<flow::Conditioning> drain; ///< none: carve where there are rivers, else flow::Conditioning::none
};

/// What ridges lie midway between: points along the rivers, or the rivers themselves.
enum class Ridges : std::uint8_t { none, voronoi, segments };

/// What else the surface must honour.
struct SkeletonRecipe {
    Ridges ridges = Ridges::none;
    double ridge_gain = 0.3;             ///< [m/m] >= 0, lambda: rise above the rivers by distance from them
    double ridge_farthest_m = 0.0;       ///< [m] >= 0, d_max: distance beyond which they rise no more; 0: none
    double ridge_noise_m = 0.0;          ///< [m] >= 0, amplitude of noise along them
    double ridge_wavelength_m = 1000.0;  ///< [m] > 0, of its longest waves
    double midpoint_inverse_cells = 0.0; ///< [cells] >= 0, L: cells beside the skeleton that follow from it; 0: none
    std::string points;                  ///< file of points with heights; "" for none
    std::int64_t scatter = 0;            ///< points at random; 0 for none
    double spacing_cells = 0.0;          ///< [cells] least distance of points at random
    skeleton::HeightLaw law = skeleton::HeightLaw::uniform;
    skeleton::Deviation deviation = skeleton::Deviation::exact; ///< of points at random
    skeleton::Falloff falloff = skeleton::Falloff::literal;     ///< of their pull to the extremes
    bool tin = false;                                           ///< write the skeleton's TIN
};

/// The land that the statistics are brought to.
enum class Prior : std::uint8_t { grf, separable, markov3, points };

/// Targets for the terrain as a whole; others stay free.
struct StatisticsRecipe {
    std::optional<double> mean;                  ///< [m]
    std::optional<double> std;                   ///< [m] > 0
    std::optional<std::array<double, 3>> max;    ///< height [m], column, row
    std::optional<std::array<double, 3>> min;    ///< likewise
    std::optional<std::array<double, 2>> length; ///< [cells] > 0, along rows and along columns
    std::optional<double> slope;                 ///< [rad] (0, pi/2) arctan of metres a cell
    std::optional<double> dimension;             ///< (2, 3)
    Prior skeleton = Prior::grf;
    double reach_cells = 6.0; ///< [cells] >= 0, R of equations 4 and 10; 0 pulls nothing
    skeleton::Falloff falloff = skeleton::Falloff::continuous;
};

enum class DetailMethod : std::uint8_t { none, midpoint };

/// The keys of section [detail] of a recipe.
struct DetailRecipe {
    DetailMethod method = DetailMethod::midpoint;
    fractal::MidpointParams midpoint;
};

/// What becomes of rivers under a patch.
enum class PatchRivers : std::uint8_t { keep, replace };

/// Real relief pasted into the land.
struct PatchRecipe {
    std::string source = {}; ///< DEM
    std::optional<std::array<double, 2>> at =
        {}; ///< [m] where its centre comes to lie; none: where it is, or the middle
    std::optional<std::array<double, 4>> window = {}; ///< [cells] of the source: column, row, width, height
    std::string mask = {};      ///< polygons, or a raster on the grid: what is pasted; "": all that is covered
    double rotate_deg = 0.0;    ///< [degrees] counterclockwise
    double scale = 1.0;         ///< > 0, in plan
    double gain = 1.0;          ///< of its heights
    double feather_cells = 0.0; ///< [cells] over which its slopes take over from the land's
    PatchRivers rivers = PatchRivers::keep;
};

} // namespace thalweg::pipeline
