// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: Random points that keep a distance look natural, where independent ones cluster. Darts are
// thrown anywhere and kept where no other point is near; tiles as wide as the distance over root 2
// hold at most one point each, so that a test looks at 25 tiles. Above a density of 0.62 darts
// seldom find room: then points are spread from those that exist, each trying 30 places one to two
// distances away. Heights have the mean and deviation exactly (normalised), then are pulled towards
// the extremes near these. scatter_between draws places between rivers, where a point rises above
// its nearest river by a random share of gain times distance.
// Source: Zhang, Liu and Li, equations 4 and 6 to 11; Bridson 2007; heights between rivers from
// Northeast Normal University 2015, equation 10.
// Cost: O(count) with few rejections; a million misses in a row end the darts. scatter_between adds
// a distance transform, O(cells). One thread, but for that.
// Not for: densities above 1.15, which no packing reaches and which are refused. Points do not know
// valleys: use them as a skeleton (surface/, geometry/triangulate.hpp).
// Example:
//     ScatteredPoints const some = scatter(grid, {.count = 200, .spacing_cells = 4.0, .std_m = 90.0});
//     FeaturePoints const& points = some.points; // some.missing found no room
// More: docs/statistics.md, "From points".

namespace thalweg::skeleton {

/// Decrease of an attraction from 1 at its centre: continuous to 0 at the radius; literal, as published, to 1/e with a
/// step.
enum class Falloff { continuous, literal };

/// An extreme height to which surrounding terrain is attracted.
struct Attraction {
    Cell centre;
    double z = 0.0;            ///< [m] target height
    double radius_cells = 1.0; ///< [cells] > 0
    Falloff falloff = Falloff::continuous;
};

/// Attracts the terrain around a cell to an extreme height. Other cells may still lie beyond it.
/// \param dem [m] by cell; NaN: no data
/// \param attraction centre, height and radius R
/// \return within R: h + w (z - h), w = exp(-d^2/R^2) (literal) or (exp(-d^2/R^2) - 1/e)/(1 - 1/e); the centre becomes
/// z, NaN stays
/// \throws BadParameter when the centre is off the grid or the radius not above 0
///
/// Source: \cite zhang, equation 4.
Raster<float> attract(Raster<float> dem, Attraction const& attraction);

/// Distribution of the heights of random points, before scaling to mean and deviation.
enum class HeightLaw : std::uint8_t { uniform, normal };

/// How the deviation of random points is obtained.
enum class Deviation : std::uint8_t {
    exact,  ///< that of the points themselves, by equation 9
    printed ///< by equation 8: heights are mean + deviation (2 u - 1), or mean + deviation n by the normal law
};

/// Options of scatter().
struct ScatterParams {
    std::uint64_t seed = 7;
    std::int64_t count = 200;   ///< [1, ...] points, the extremes included
    double spacing_cells = 0.0; ///< [cells] >= 0, least distance of any two points
    double mean_m = 0.0;        ///< [m] of points that are not extremes
    double std_m = 1.0;         ///< [m] >= 0, population standard deviation of these
    HeightLaw law = HeightLaw::uniform;
    std::optional<Vec3> highest = std::nullopt; ///< [m] an additional point; others stay below it
    std::optional<Vec3> lowest = std::nullopt;  ///< [m] an additional point; others stay above it
    double reach_cells = 0.0;                   ///< [cells] >= 0, radius of the attraction to extremes
    Deviation deviation = Deviation::exact;
    Falloff falloff = Falloff::literal; ///< of that attraction
};

/// The density up to which darts find room for points; above it they are spread (Bridson).
inline constexpr double darts_density = 0.62;

/// What scatter() returns.
struct ScatteredPoints {
    FeaturePoints points;     ///< extremes first: highest, then lowest
    std::int64_t missing = 0; ///< fewer than count: no more room was found
    double density = 0.0;     ///< count spacing^2 / area; dart throwing jams at 0.6965, 1.1547 is the densest packing
};

/// Scatters random points over a grid, at a minimum distance, with heights of given mean and deviation.
/// \param grid contains the extremes, which keep the spacing
/// \return distances are exactly >= spacing; `count` points, or fewer and their number in `missing`. Heights have the
/// mean and deviation before the attraction to extremes (exact; printed: uniform ones have std / sqrt 3 in
/// expectation), then lie strictly between the extremes.
/// \throws BadParameter with the density, when no packing can hold the points
///
/// Source: \cite zhang, equations 6 to 11; up to a density of 0.62 darts, above it \cite bridson2007 (denser).
ScatteredPoints scatter(Grid const& grid, ScatterParams const& params, Run const& run = {});

/// Options of scatter_between().
struct ScatterBetweenParams {
    std::uint64_t seed = 7;
    std::int64_t count = 200;           ///< [0, ...] points
    double spacing_cells = 0.0;         ///< [cells] >= 0, least distance of any two points
    double gain = 0.3;                  ///< [m/m] >= 0, largest rise of a point above its river per distance
    double farthest_m = 0.0;            ///< [m] >= 0, distance beyond which points do not rise; 0: none
    HeightLaw law = HeightLaw::uniform; ///< of a point's share of that rise
};

/// Scatters random feature points between rivers, which rise with distance from the nearest river. The first points lie
/// in cells of the grid's border, corners included, spaced as points that spread evenly, so that triangles of the
/// points cover the grid; the others anywhere. A point is at z + gain d share: z of the nearest river cell (ties:
/// lowest index), d its distance [m], at most farthest_m, share uniform in [0, 1], or normal around 1/2 with deviation
/// 1/6, redrawn beyond [0, 1].
/// \param valley [m] heights of river cells, at least one
/// \param inside 0: no points; empty: points anywhere
/// \return distances of points are exactly >= spacing, those of cells of points and rivers >= spacing and >= 2 cells;
/// `count` points, or fewer and their number in `missing`
/// \throws BadParameter with the density, when no packing can hold the points
/// \throws BadInput when there is no river cell, or inside is on another grid
///
/// Source: \cite zhang, equations 6 to 8 and 11, heights by equation 10 of \cite nenu2015 with a random share.
ScatteredPoints scatter_between(Valley const& valley, Mask const& inside, ScatterBetweenParams const& params = {},
                                Run const& run = {});

} // namespace thalweg::skeleton
