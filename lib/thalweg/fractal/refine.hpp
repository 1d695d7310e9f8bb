// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/large_pages.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/fractal/noise_row.hpp>
#include <thalweg/fractal/stencil_weights.hpp>

/// Inside of midpoint: a dense lattice per level, each streamed row by row from the one above.
namespace thalweg::fractal {

/// H and sigma at the coarse points, bilinear between them; without steps the same everywhere.
struct Character {
    static constexpr double steps_of_hurst = 256.0; ///< where H changes from place to place it does so in such steps
    double hurst = 0.5;
    double sigma = 0.0;               ///< [m] a coarse cell apart
    Indexed<CellIndex, float> steps;  ///< H x steps_of_hurst
    Indexed<CellIndex, float> sigmas; ///< [m] a coarse cell apart
    bool varies() const { return !steps.empty(); }
};

/// What the levels are made with. Points of every level are kept to the north-western part that the result needs.
struct Refinement {
    Raster<float> const* coarse = nullptr; ///< finite heights and NaN
    bool holes = false;                    ///< whether the coarse raster holds NaN
    int levels = 1;                        ///< [1, ...]
    Stencil stencil = Stencil::sixteen;
    Noise noise = Noise::normal;
    std::uint64_t seed = 0;
    Character character;
    Lanes lanes = Lanes::plain;
};

/// Lattices between the coarse raster and the result, to be used again.
using Floor = std::vector<float, LargePages<float>>;
/// Scratch space of refine().
struct Floors {
    Floor odd;
    Floor even;
};

/// Writes a level 2^levels finer than the coarse raster, from its north-western corner.
/// \post every byte of dem.
/// \param refinement what to refine, and how
/// \param dem no more columns and rows than (coarse columns - 1) 2^levels + 1, any content
/// \param floors scratch space
/// \param run progress, log, stop token and number of threads
/// \throws Cancelled
void refine(Refinement const& refinement, Raster<float>& dem, Floors& floors, Run const& run);

} // namespace thalweg::fractal
