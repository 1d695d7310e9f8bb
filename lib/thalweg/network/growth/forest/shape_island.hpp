// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

/// Options of shape_island().
struct IslandParams {
    double ruggedness = 0.5; ///< [0, 1] how far fjords and capes reach; 0: an oval
    std::uint64_t seed = 7;
};

/// Draws an island: an oval that is bent, its coast moved in and out by noise of all wavelengths from the grid's side
/// to 8 cells. About two fifths of the grid are land.
/// \param grid a grid of at least 16 x 16 cells
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return 1 on land, without lagoons, islets of less than a thousandth of the grid or land nearer to the grid's border
/// than a fortieth of its shorter side; the same mask for any number of threads.
/// \throws BadParameter
/// \throws BadInput for a grid that is too small
/// \throws Cancelled
///
/// Source: gradient noise (\cite perlin1985), each octave turned.
Mask shape_island(Grid const& grid, IslandParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
