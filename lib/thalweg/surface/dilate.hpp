// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run.hpp>
#include <thalweg/core/valley.hpp>
#include <thalweg/surface/increment.hpp>

namespace thalweg::surface {

enum class Metric : std::uint8_t {
    cityblock, ///< the paper's 4-neighbourhood
    euclid     ///< exact Euclidean distance, H interpolated linearly
};

struct DilateParams {
    IncrementParams increment;
    Metric metric = Metric::cityblock;
    double relief_m = 0.0; ///< [m] scales the increments so that their greatest sum on this grid is this; 0: papers' units x cell
};

/// How far a cell is from its valley, and the valley's height.
struct Expansion {
    Raster<std::int32_t> level; ///< number of dilations; 0 in the valley, -1 where none comes
    Raster<float> base;         ///< [m] height of the valley cell it rises from; NaN where none comes
};

/// The paper's successive dilation, level by level from a frontier of (level, base); cells with inside = 0 are barriers.
/// Throws: BadInput for an empty valley.
Expansion expand_frontier(Valley const& valley, Mask const& inside, Run const& run = {});

/// The same without barriers as a closed form: base = min{e_v : |c - v| = d(c)}, city-block; equal to the frontier bit for bit.
Expansion expand(Valley const& valley, Run const& run = {});

struct Dilated {
    Raster<float> dem;              ///< [m] NaN where no dilation came
    std::vector<double> increments; ///< [m] dh(x), x = 1 .. levels, as used
    std::int64_t levels = 0;        ///< greatest number of dilations
    double flat_share = 0.0;        ///< [0,1] cells off the valley without a lower 4-neighbour
};

/// Draws the surface E = e_v + H(d) through a valley by successive dilation.
/// Gives: valley cells exact; every other cell inside is its lowest finished 4-neighbour plus dh (cityblock).
/// Throws: BadInput for an empty valley; BadParameter.
/// Source: paper 000, equations 3 and 4, Table 1; specification 0.4.
Dilated dilate(Valley const& valley, DilateParams const& params = {}, Run const& run = {});
Dilated dilate(Valley const& valley, Mask const& inside, DilateParams const& params = {}, Run const& run = {});

} // namespace thalweg::surface
