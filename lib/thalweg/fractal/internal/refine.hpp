// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/fractal/midpoint.hpp>

/// Implementation of midpoint: one dense lattice per level, each streamed row by row from the coarser one.
namespace thalweg::fractal {

/// H and sigma at the coarse points, bilinear between them; without `steps` uniform.
struct Character {
    static constexpr double steps_of_hurst = 256.0; ///< local H has a resolution of 1 / 256
    double hurst = 0.5;
    double sigma = 0.0;        ///< [m] one coarse cell apart
    std::vector<float> steps;  ///< H x steps_of_hurst
    std::vector<float> sigmas; ///< [m] one coarse cell apart
    bool varies() const { return !steps.empty(); }
};

/// Input of refine(). Lattices of every level are cut to the north-western part that the result needs.
struct Refinement {
    Raster<float> const* coarse = nullptr; ///< finite heights and NaN
    bool holes = false;                    ///< the coarse raster has NaN
    int levels = 1;                        ///< [1, ...]
    Stencil stencil = Stencil::sixteen;
    Noise noise = Noise::normal;
    std::uint64_t seed = 0;
    Character character;
    Lanes lanes = Lanes::plain;
};

/// A lattice between the coarse raster and the result, reusable.
using Floor = std::vector<float, LargePages<float>>;
/// Scratch space of refine().
struct Floors {
    Floor odd;
    Floor even;
};

/// Writes the lattice 2^levels finer than the coarse raster, from its north-western corner.
/// \param refinement coarse raster, levels, stencil, noise, H and sigma
/// \param dem at most (coarse columns - 1) 2^levels + 1 columns, rows likewise; every byte is written
/// \param floors scratch space
void refine(Refinement const& refinement, Raster<float>& dem, Floors& floors, Run const& run);

} // namespace thalweg::fractal
