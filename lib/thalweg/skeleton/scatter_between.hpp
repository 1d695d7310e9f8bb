// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>
#include <thalweg/skeleton/scatter.hpp>

namespace thalweg::skeleton {

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
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return distances of points are exactly >= spacing, those of cells of points and rivers >= spacing and >= 2 cells;
/// `count` points, or fewer and their number in `missing`
/// \throws BadParameter with the density, when no packing can hold the points
/// \throws BadInput when there is no river cell, or inside is on another grid
/// \throws Cancelled
///
/// Source: \cite zhang, equations 6 to 8 and 11, heights by equation 10 of \cite nenu2015 with a random share.
Scattered scatter_between(Valley const& valley, Mask const& inside, ScatterBetweenParams const& params = {},
                          Run const& run = {});

} // namespace thalweg::skeleton
