// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

/// A section through the terrain. Heights are bilinear between cell centres; NaN: one of these has none.
struct Section {
    enum class Kind { river, row, column }; ///< across a river; along the middle row or column
    Kind kind = Kind::river;
    double from_outlet_m = 0.0; ///< position of the crossing with the river, along the stream
    Vec2 begin;                 ///< [m] ends in plan; looking downstream, begin is on the left
    Vec2 end;
    std::vector<Vec2> points; ///< x [m] from the river to the right (row: from the west end; column: from the south
                              ///< end), y height [m] or NaN
};

/// Makes sections across the main stem, perpendicular to it, at evenly spaced positions between a tenth and nine tenths
/// of its length, from the upper to the lower; each extends to the DEM's border, but at most a quarter of the stem's
/// length or 12 cells.
/// \param dem [m] by cell; NaN: no data
/// \param network null: sections along the middle row and column
/// \param orders the network's orders; null without a network
/// \param count >= 1, number of sections
/// \return none for positions off the DEM
/// \throws BadInput when the DEM has no cells
std::vector<Section> cut_sections(Raster<float> const& dem, ElevatedNetwork const* network, NetworkOrders const* orders,
                                  int count);

/// Interpolates the height at a position: bilinear between the four cell centres around it, constant beyond the
/// outermost.
/// \param dem [m] by cell; NaN: no data
/// \param position [m] any
/// \return [m] NaN: off the grid, or a contributing cell has no height
double height_at(Raster<float> const& dem, Vec2 position);

/// A layer of rock in a section.
struct LayerBelow {
    double top_m = 0.0;    ///< above the bed; of the topmost one infinite
    double strength = 1.0; ///< > 0: firm layers are drawn darker
};

/// Layers of rock below the ground.
struct LayersBelow {
    Raster<float> bed = {}; ///< [m] on the DEM's grid: what the layers lie on; without cells: there are none
    std::vector<LayerBelow> layers = {}; ///< from the lowest up, as far as the terrain reaches
};

/// The colour of a layer of rock on maps and sections: the firmer, the darker.
/// \param strength of a layer, > 0
/// \return "#rrggbb"
std::string layer_colour(double strength);

/// Options of sections().
struct SectionsParams {
    std::string title;   ///< "" for none
    int count = 5;       ///< [1, 9] across the main stem
    int width_px = 1000; ///< [200, 8000]; the height follows from the number of cuts
    Format format = Format::svg;
    LayersBelow below = {}; ///< drawn below the ground
};

/// Draws cross-sections of the valley, one below the other from the upper to the lower, all on the same scales, with a
/// key map of their positions. Lines are interrupted where heights are missing.
/// \param dem [m] by cell; NaN: no data
/// \param network null: sections along the middle row and column
/// \param orders the network's orders; null without a network
/// \return the picture
/// \throws BadInput when the DEM has no cells or the orders belong to another network
Picture sections(Raster<float> const& dem, ElevatedNetwork const* network, NetworkOrders const* orders,
                 SectionsParams const& params = {});

} // namespace thalweg::draw
