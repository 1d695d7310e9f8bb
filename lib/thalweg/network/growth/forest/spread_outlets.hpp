// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

/// \param land 0 for sea
/// \return the land's cells that touch the sea by a side, or lie on the grid's border, in ascending order of their
/// index.
std::vector<Cell> coast_cells(Mask const& land);

/// Options of spread_outlets().
struct SpreadOutletsParams {
    std::int64_t count = 0;    ///< [0, ...] of outlets; 0: one for every every_cells of the coast
    double every_cells = 60.0; ///< [cells] > 0, for the coast is cells
    std::uint64_t seed = 7;
};

/// Spreads the mouths of rivers along a coast, at distances that chance decides: rather in bays than on capes.
/// \pre land; the cells of its coast where mouths may lie.
/// \param land the cells of land; 0: sea
/// \param coast cells of the coast
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return as many of these cells as asked, or all that lie three cells apart where there are fewer, in the order in
/// which chance took them.
/// \throws BadParameter
/// \throws BadInput for no cell
std::vector<Cell> spread_outlets(Mask const& land, std::vector<Cell> const& coast,
                                 SpreadOutletsParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
