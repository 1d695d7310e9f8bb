// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

/// Lists the land cells that share a side with the sea or lie on the grid's border.
/// \param land 0: sea
/// \return ascending by index
std::vector<Cell> coast_cells(Mask const& land);

/// Options of spread_outlets().
struct SpreadOutletsParams {
    std::int64_t count = 0;    ///< [0, ...] number of outlets; 0: from every_cells
    double every_cells = 60.0; ///< [cells] > 0, length of coast per outlet
    std::uint64_t seed = 7;
};

/// Chooses outlets at random along a coast, more often in bays than on capes.
/// \param land 0: sea
/// \param coast cells where outlets may lie, at least one
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return `count` of these cells, in the order they were drawn, at least three cells apart; fewer if no more fit
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for an empty coast
std::vector<Cell> spread_outlets(Mask const& land, std::vector<Cell> const& coast,
                                 SpreadOutletsParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
