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

/// How heights of scattered points are distributed before they are brought to mean and deviation.
enum class HeightLaw : std::uint8_t { uniform, normal };

/// What the deviation of scattered points is.
enum class Deviation : std::uint8_t {
    exact,  ///< that of the points themselves, as equation 9 brings it about
    printed ///< as in equation 8: heights are mean + deviation (2 u - 1), or mean + deviation n by the normal law
};

/// Options of scatter().
struct ScatterParams {
    std::uint64_t seed = 7;
    std::int64_t count = 200;   ///< [1, ...] points, the extremes included
    double spacing_cells = 0.0; ///< [cells] >= 0, least distance of any two points
    double mean_m = 0.0;        ///< [m] of the points that are not extremes
    double std_m = 1.0;         ///< [m] >= 0, likewise; population deviation
    HeightLaw law = HeightLaw::uniform;
    std::optional<Vec3> highest = std::nullopt; ///< [m] a point of its own; others stay below it
    std::optional<Vec3> lowest = std::nullopt;  ///< [m] likewise, above it
    double reach_cells = 0.0;                   ///< [cells] >= 0, R: within it heights are drawn to the extremes
    Deviation deviation = Deviation::exact;
    Falloff falloff = Falloff::literal; ///< of that pull
};

/// What scatter() returns.
struct Scattered {
    FeaturePoints points;     ///< extremes first: highest, then lowest
    std::int64_t missing = 0; ///< of the wanted count: no more room was found
    double density = 0.0;     ///< count spacing^2 / area; 0.6965 is where darts jam, 1.1547 the densest packing
};

/// Points at random on a grid's ground, no two nearer than a given distance, with heights of given mean and deviation.
/// \param grid extremes inside the grid, apart by the spacing or more
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return distances >= spacing exactly; exactly count points or how many are missing; heights of mean and deviation
/// before they are drawn to the extremes (Deviation::exact; as printed uniform ones deviate by std / sqrt 3, in the
/// mean), then strictly between these.
/// \throws BadParameter with the density, when no packing could hold the points
///
/// Source: \cite zhang, equations 6 to 11; up to a density of 0.62 darts, above it \cite bridson2007 (denser).
Scattered scatter(Grid const& grid, ScatterParams const& params, Run const& run = {});

} // namespace thalweg::skeleton
