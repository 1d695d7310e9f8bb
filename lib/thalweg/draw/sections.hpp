// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

/// Options of sections().
struct SectionsParams {
    std::string title;   ///< "" for none
    int count = 5;       ///< [1, 9] across the main stem
    int width_px = 1000; ///< [200, 8000]; the height follows from the number of cuts
    Format format = Format::svg;
};

/// \pre a DEM, and its network with orders or nullptr for both: then the middle row and column are cut. Where heights
/// are missing the line is broken.
/// \param dem [m] heights by cell; NaN: no data
/// \param network the network
/// \param orders the network's orders
/// \param params options, each with its default, unit and range
/// \return Cross-sections of the valley, one below the other from the upper to the lower, all on the same scales, with
/// a key map that shows where each lies.
/// \throws BadParameter
/// \throws BadInput when the DEM has no cells or orders are of another network
Picture sections(Raster<float> const& dem, ElevatedNetwork const* network, NetworkOrders const* orders,
                 SectionsParams const& params = {});

} // namespace thalweg::draw
