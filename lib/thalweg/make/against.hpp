// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/measure/likeness/likeness.hpp>
#include <thalweg/measure/relief/hypsometry.hpp>
#include <thalweg/recipe/plan.hpp>

namespace thalweg::make {

/// Slopes and heights of a terrain, in the cells that are compared.
struct ReliefShape {
    double mean_slope_deg = 0.0;
    double hypsometric_integral = 0.0;
    std::vector<double> slopes; ///< [0, 1] of cells, classes of 2 degrees up to 90
    std::vector<measure::HypsometricPoint> hypsometry;
};

/// A terrain beside the DEM of output.against.
struct TerrainAgainst {
    std::string key;  ///< terrain, cone, tin or dilation
    std::string name; ///< in words
    ReliefShape shape;
    measure::Likeness like;
};

/// Pairs of heights, counted in square classes.
struct HeightPairs {
    double low_m = 0.0;
    double high_m = 0.0;
    std::int64_t side = 64;
    std::vector<std::int64_t> counts; ///< side x side; column: in the DEM, row: in the terrain, from low to high
};

/// A terrain and the DEM of output.against, with three simpler terrains around the same rivers.
struct Against {
    std::string dem; ///< its file
    std::int64_t cells = 0;
    ReliefShape real;
    std::vector<TerrainAgainst> terrains; ///< the recipe's own, then the others
    HeightPairs pairs;
    Raster<float> difference; ///< [m] terrain minus DEM; NaN: not known
    Mask divides_of_dem;      ///< as measure::ComparedTerrains
    Mask divides;             ///< likewise of the terrain
};

/// Compares a terrain with the DEM of output.against. The cone rises evenly with the distance to the nearest river, the
/// TIN joins the rivers, dilation rises from a harmonic surface through them; cone and dilation have the DEM's mean
/// slope.
/// \param of_file as Plan::against
/// \param name of its file
/// \pre the terrain has rivers and a surface
/// \throws BadInput when fewer than 100 cells of the grid can be compared
Against compare_with_dem(Raster<float> const& of_file, std::string const& name, Terrain const& terrain,
                         Run const& run = {});

/// \internal
/// In one line: "r 0.984, above rivers 0.76, ..., beside a cone ...".
std::string line_of(Against const& against);

} // namespace thalweg::make
