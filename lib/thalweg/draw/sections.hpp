// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

/// A cut through the land. Heights are bilinear between the centres of cells, NaN where one of these has none.
struct Section {
    enum class Kind { river, row, column }; ///< across a river; along the middle row or column
    Kind kind = Kind::river;
    double from_outlet_m = 0.0; ///< of the place where it crosses the river, along the stream
    Vec2 begin;                 ///< [m] ends in plan; looking downstream, begin is on the left
    Vec2 end;
    std::vector<Vec2> points; ///< x [m] from the river to the right (row: from the west end; column: from the south
                              ///< end), y height [m] or NaN
};

/// Cuts across the main stem, square to it at evenly spaced places between a tenth and nine tenths of its length, from
/// the upper to the lower; each reaches to the DEM's edge, but no further than a quarter of the stem's length or 12
/// cells.
/// \pre a network and its orders, or none: then the middle row and column are cut. count >= 1.
/// \param dem [m] heights by cell; NaN: no data
/// \param network the network
/// \param orders the network's orders
/// \param count how many
/// \return nothing for places off the DEM.
/// \throws BadInput when the DEM has no cells
std::vector<Section> cut_sections(Raster<float> const& dem, ElevatedNetwork const* network, NetworkOrders const* orders,
                                  int count);

/// Height at a position [m], bilinear between the four centres of cells around it, level beyond the outermost; NaN off
/// the grid or where a cell that counts has no height.
/// \param dem [m] heights by cell; NaN: no data
/// \param position [m] the position
/// \return the height
double height_at(Raster<float> const& dem, Vec2 position);

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
/// \return Cross-sections of the valley, one below the other from the upper to the lower, all on the same scales, with
/// a key map that shows where each lies.
/// \throws BadInput when the DEM has no cells or orders are of another network
Picture sections(Raster<float> const& dem, ElevatedNetwork const* network, NetworkOrders const* orders,
                 SectionsParams const& params = {});

} // namespace thalweg::draw
