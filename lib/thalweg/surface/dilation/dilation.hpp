// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/dilation/increment.hpp>

// Idea: Slopes grow outward from the valley. The valley is dilated cell by cell; at the x-th
// dilation new cells stand dh(x) above the lowest neighbour of the step before. Without barriers
// this has a closed form: height of the nearest river cell by city-block distance d (of equally
// near ones the lowest) plus H(d) = dh(1) + ... + dh(d). The pair (distance, height) is minimised
// lexicographically by one sweep down and one up, many cells at a time by vector instructions.
// dilate_over replaces the river's height by a base surface: with a harmonic base slopes of
// neighbouring valleys meet without the scarps that the published base leaves at ridges.
// Source: Cao, Long and Lü 2009, equations 3 and 4, table 1; the closed form, which tests compare
// with expand_frontier, and the harmonic base are ours: docs/decisions/0009-harmonic-base.md.
// Cost: O(n). docs/performance.md: 3.7 ns and 10 bytes a cell for 8192 x 8192, 11 times a memcpy.
// Bands of rows and strips of columns run on all cores. With barriers a frontier on one thread,
// about 17 times as long.
// Not for: drainage. Heights depend on distance alone, so water leaves rivers diagonally and a few
// pits lie where slopes meet: condition the result (flow/condition.hpp), or take equilibrium.hpp.
// City-block distance makes diamonds around points; Metric::euclid does not.
// Example:
//     DilatedDem const paper = dilate(valley, {.increment = {"uniform"}, .relief_m = 300.0});
//     DilatedDem const smooth = dilate_over(valley, harmonic(valley), {.relief_m = 300.0});
// More: docs/rivers.md, "The base of slopes".

namespace thalweg::surface {

enum class Metric : std::uint8_t {
    cityblock, ///< the 4-neighbourhood of Cao, Long and Lü
    euclid     ///< exact Euclidean distance, H interpolated linearly; barriers do not lengthen paths
};

/// Options of dilate().
struct DilateParams {
    IncrementParams increment = {};
    Metric metric = Metric::cityblock;
    double relief_m =
        0.0; ///< [m] scales the increments so that their greatest sum on this grid is this; 0: papers' units x cell
};

/// Distance of cells from the valley, and the valley's height there.
struct Expansion {
    Raster<std::int32_t> level; ///< number of dilations; 0: valley, -1: not reached
    Raster<float> base;         ///< [m] height of the valley cell it is counted from; NaN: not reached
};

/// Computes the successive dilation of Cao, Long and Lü, level by level from a frontier of (level, base).
/// \param valley [m] heights of river cells
/// \param inside in the valley's frame: 0: barrier; valley cells there do not count
/// \return base: the lowest base of the 4-neighbours of the previous level (-0 below +0); cells not reached have level
/// -1 and base NaN
/// \throws BadInput for no valley cell inside, an infinite height, or a mask in another frame
///
/// Source: \cite cao2009, equation 3.
Expansion expand_frontier(Valley const& valley, Mask const& inside, Run const& run = {});

/// Computes expand_frontier without barriers in closed form: level = d(c), base = min{e_v : |c - v| = d(c)},
/// city-block.
/// \param valley [m] heights of river cells
/// \return the same bytes as expand_frontier
/// \throws BadInput for no valley cell or an infinite height
Expansion expand(Valley const& valley, Run const& run = {});

/// What dilate() returns.
struct DilatedDem {
    Raster<float> dem;              ///< [m] NaN: not reached
    std::vector<double> increments; ///< [m] dh(x), x = 1 ... levels, as applied
    std::int64_t levels = 0;        ///< largest number of dilations (euclid: largest distance in cells, rounded up)
    double rise_m = 0.0;            ///< [m] largest sum of increments on this grid, as applied
    double flat_share = 0.0;        ///< [0, 1] share of the cells off the valley without a lower 4-neighbour
};

/// Builds the surface E = e_v + H(d) from a valley by successive dilation. With `inside`, a mask in the valley's frame,
/// cells of 0 are barriers without heights, and valley cells there do not count.
/// \param valley [m] heights of river cells
/// \return valley cells bit for bit; cityblock: every other cell is its lowest 4-neighbour of the previous level plus
/// dh, added in double and rounded once
/// \throws BadInput for no valley cell (inside), an infinite height, a mask in another frame, or a cell size not above
/// 0
/// \throws BadParameter for increments as in increments(), a relief below 0, a relief for increments that do not rise,
/// or heights beyond float
///
/// Source: \cite cao2009, equations 3 and 4, Table 1.
DilatedDem dilate(Valley const& valley, DilateParams const& params = {}, Run const& run = {});
DilatedDem dilate(Valley const& valley, Mask const& inside, DilateParams const& params = {}, Run const& run = {});

/// Builds the surface E = base + H(d), whose slopes rise from a base surface instead of from valley cells. With
/// `inside` as dilate.
/// \param valley [m] heights of river cells
/// \param base [m] by cell, in the valley's frame, e.g. harmonic(valley); not read in valley cells
/// \return valley cells bit for bit; NaN where base is NaN or no dilation reaches. A smooth base leaves no step between
/// the slopes of two valleys.
/// \throws Error as dilate
/// \throws BadInput when the base has another frame
///
/// Source: docs/decisions/0009-harmonic-base.md, where base = harmonic(valley).
DilatedDem dilate_over(Valley const& valley, Raster<float> const& base, DilateParams const& params = {},
                       Run const& run = {});
DilatedDem dilate_over(Valley const& valley, Raster<float> const& base, Mask const& inside,
                       DilateParams const& params = {}, Run const& run = {});

} // namespace thalweg::surface
