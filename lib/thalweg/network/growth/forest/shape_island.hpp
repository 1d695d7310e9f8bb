// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

/// Options of shape_island().
struct IslandParams {
    double ruggedness = 0.5; ///< [0, 1] reach of fjords and capes; 0: an oval
    std::uint64_t seed = 7;
};

/// Draws an island that covers about two fifths of the grid: a bent oval with a coast moved by noise of all wavelengths
/// from the grid's side to 8 cells.
/// \param grid at least 16 x 16 cells
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return 1: land, without lagoons and without islets smaller than a thousandth of the grid; land keeps a fortieth of
/// the shorter side from the border. The same mask for any number of threads.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for a smaller grid
/// \throws Cancelled
///
/// Source: gradient noise (\cite perlin1985), each octave turned.
Mask shape_island(Grid const& grid, IslandParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
