// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/feature_points.hpp>
#include <thalweg/core/grid.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/skeleton/attract.hpp>

namespace thalweg::skeleton {

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

/// What scatter() returns.
struct Scattered {
    FeaturePoints points;     ///< extremes first: highest, then lowest
    std::int64_t missing = 0; ///< fewer than count: no more room was found
    double density = 0.0;     ///< count spacing^2 / area; dart throwing jams at 0.6965, 1.1547 is the densest packing
};

/// Scatters random points over a grid, at a minimum distance, with heights of given mean and deviation.
/// \param grid contains the extremes, which keep the spacing
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return distances are exactly >= spacing; `count` points, or fewer and their number in `missing`. Heights have the
/// mean and deviation before the attraction to extremes (exact; printed: uniform ones have std / sqrt 3 in
/// expectation), then lie strictly between the extremes.
/// \throws BadParameter with the density, when no packing can hold the points
///
/// Source: \cite zhang, equations 6 to 11; up to a density of 0.62 darts, above it \cite bridson2007 (denser).
Scattered scatter(Grid const& grid, ScatterParams const& params, Run const& run = {});

} // namespace thalweg::skeleton
