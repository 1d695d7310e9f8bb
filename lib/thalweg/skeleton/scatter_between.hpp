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
    double gain = 0.3;                  ///< [m/m] >= 0, greatest rise of a point above its river by distance
    double farthest_m = 0.0;            ///< [m] >= 0, distance beyond which points rise no more; 0: none
    HeightLaw law = HeightLaw::uniform; ///< of the share of that rise which a point has
};

/// Feature points at random between rivers, as high as the nearest river and more with distance.
/// \pre a valley with at least one river cell
/// \param valley [m] heights of the river cells
/// \param inside cells that points may lie in, on its grid; without cells: all
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return distances of points >= spacing exactly, and between the cells of points and rivers >= the spacing and >= 2
/// cells; exactly count points or how many are missing. The first of them lie in cells of the grid's border, corners
/// included, as far apart as points are that spread evenly, so that triangles of the points cover the grid; the others
/// anywhere. A point stands at z + gain d share: z of the river cell nearest to its cell (of equally near ones that of
/// the lowest index), d the distance of the two cells [m], farthest_m at most, share in [0, 1]: uniform there, or
/// normal around 1/2 with a deviation of 1/6, drawn again beyond it.
/// \throws BadParameter with the density, when no packing could hold the points
/// \throws BadInput when no cell has a river or inside has another grid
/// \throws Cancelled
///
/// Source: \cite zhang, equations 6 to 8 and 11, heights by equation 10 of \cite nenu2015 with a random share.
Scattered scatter_between(Valley const& valley, Mask const& inside, ScatterBetweenParams const& params = {},
                          Run const& run = {});

} // namespace thalweg::skeleton
