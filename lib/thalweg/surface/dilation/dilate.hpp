// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>
#include <thalweg/surface/dilation/increment.hpp>

namespace thalweg::surface {

enum class Metric : std::uint8_t {
    cityblock, ///< the 4-neighbourhood of Cao, Long and Lü
    euclid     ///< exact Euclidean distance, H interpolated linearly; barriers do not lengthen the way
};

/// Options of dilate().
struct DilateParams {
    IncrementParams increment = {};
    Metric metric = Metric::cityblock;
    double relief_m =
        0.0; ///< [m] scales the increments so that their greatest sum on this grid is this; 0: papers' units x cell
};

/// How far a cell is from its valley, and the valley's height.
struct Expansion {
    Raster<std::int32_t> level; ///< number of dilations; 0 in the valley, -1 where none comes
    Raster<float> base;         ///< [m] height of the valley cell it rises from; NaN where none comes
};

/// The successive dilation of Cao, Long and Lü, level by level from a frontier of (level, base).
/// \param valley [m] heights of the river cells
/// \param inside of the valley's frame; cells with 0 are barriers, and a valley cell there does not count
/// \param run progress, log, stop token and number of threads
/// \return base = min of the bases of the 4-neighbours of level d - 1 (-0 below +0). Cells no dilation reaches: -1 and
/// NaN.
/// \throws BadInput no valley cell inside, an infinite height, another frame
///
/// Source: \cite cao2009, equation 3; specification 0.4.
Expansion expand_frontier(Valley const& valley, Mask const& inside, Run const& run = {});

/// The same without barriers as a closed form: level = d(c), base = min{e_v : |c - v| = d(c)}, city-block.
/// \param valley [m] heights of the river cells
/// \param run progress, log, stop token and number of threads
/// \return the bytes of expand_frontier.
/// \throws BadInput no valley cell, an infinite height
///
/// Source: specification 0.4.
Expansion expand(Valley const& valley, Run const& run = {});

/// What dilate() returns.
struct Dilated {
    Raster<float> dem;              ///< [m] NaN where no dilation came
    std::vector<double> increments; ///< [m] dh(x), x = 1 .. levels, as used
    std::int64_t levels = 0;        ///< greatest number of dilations (euclid: greatest distance in cells, rounded up)
    double rise_m = 0.0;            ///< [m] greatest sum of increments on this grid, as used: what relief_m asks for
    double flat_share = 0.0;        ///< [0,1] of the cells of the DEM off the valley: those without a lower 4-neighbour
};

/// Draws the surface E = e_v + H(d) through a valley by successive dilation.
/// \param valley heights of the river cells. inside: of the valley's frame; cells with 0 are barriers and get no
/// height, and a valley cell there does not count. The Euclidean distance passes through barriers
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return valley cells exact; every other cell inside is its lowest finished 4-neighbour plus dh (cityblock), added in
/// double and rounded once.
/// \throws BadInput no valley cell (inside), an infinite height, another frame, a cell size not above 0
/// \throws BadParameter increments (see increment.hpp), relief below 0, a relief asked of increments that do not rise,
/// heights beyond a float
///
/// Source: \cite cao2009, equations 3 and 4, Table 1; specification 0.4.
Dilated dilate(Valley const& valley, DilateParams const& params = {}, Run const& run = {});
Dilated dilate(Valley const& valley, Mask const& inside, DilateParams const& params = {}, Run const& run = {});

} // namespace thalweg::surface
