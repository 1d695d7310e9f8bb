// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

/// Inside of midpoint: Stencil::exact.
namespace thalweg::fractal {

/// What a fractional Brownian surface through coarse heights is made with.
struct Conditioning {
    Raster<float> const* coarse = nullptr; ///< finite heights and NaN
    int levels = 1;                        ///< [1, ...] times each cell is halved
    double hurst = 0.5;                    ///< H
    double sigma = 0.0;                    ///< [m] a coarse cell apart
    std::uint64_t seed = 0;
};

/// Writes a lattice 2^levels finer than the coarse raster, from its north-western corner: a random fractional Brownian
/// surface plus what ordinary kriging, with its variogram, makes of the differences to the coarse heights.
/// Takes: dem: no more columns and rows than (coarse columns - 1) 2^levels + 1, any content.
/// Gives: every cell of dem: the bits of the coarse heights where they lie, NaN where all the nearest coarse cells are
/// holes, and between them the surface under the condition that it passes through the heights. A smaller dem is part of
/// a larger one bit for bit; the same bytes for any number of threads.
/// Throws: BadParameter: more than most_conditioning_cells heights, or a lattice too large for the solver; Cancelled.
/// Source: Stein 2002 (the surface); conditioning by kriging as in Journel and Huijbregts 1978; specification 1.6.
void condition_surface(Conditioning const& conditioning, Raster<float>& dem, Run const& run);

} // namespace thalweg::fractal
