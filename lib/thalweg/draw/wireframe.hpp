// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/draw/picture.hpp>

// Idea: In parallel projection from above, a point of the net is hidden exactly if a line nearer to
// the viewer is higher in its column of the sheet. So one needs no depths, only a horizon: the
// highest line so far in every column, kept as pieces of straight lines. Meshes are taken from
// front to back; of each of their sides the parts above the horizon are drawn, and the side then
// raises it. Terrain has no overhangs, so that one horizon suffices. Rivers are cut at the meshes
// they cross and tested in the same order, a little below the horizon, since they lie on it. Knots
// are means of the cells around them: with less the net is noisy, with more valleys fill up.
// Source: floating horizon, Wright 1973; the net as in the perspective figures of Zhang, Liu and Li
// (zhang in docs/references.bib).
// Cost: about k^1.5 for k knots, 40 000 at most: each side finds the pieces of the horizon above it
// by binary search and replaces them. The DEM is read once, for the means. One thread.
// Not for: a view with perspective, or from below; elevations near 0 and 90 degrees. Small streams,
// which would hide the net: only the three highest orders are drawn. A picture of every cell:
// map.hpp.
// Example:
//     WireframeScene const scene{.dem = dem, .network = &elevated, .orders = &network_orders};
//     double const azimuth_deg = azimuth_up_valley(scene);
//     Picture const picture = wireframe(scene, {.title = "Valley", .azimuth_deg = azimuth_deg});
// More: docs/commands.md, "Pictures".

namespace thalweg::draw {

/// Options of wireframe().
struct WireframeParams {
    std::string title;           ///< UTF-8; "" for none
    double azimuth_deg = 30.0;   ///< any; viewing direction, clockwise from north
    double elevation_deg = 32.0; ///< [5, 85] elevation of the viewer above the horizon
    double exaggeration = 0.0;   ///< [0, 1e6] of heights; 0: a round number is chosen
    int lines = 60;              ///< [2, 200] at most, each way
    int width_px = 1200;         ///< [200, 8000]; the height follows
    Format format = Format::svg;
};

/// The content of a wireframe.
struct WireframeScene {
    Raster<float> const& dem;
    ElevatedNetwork const* network = nullptr;
    NetworkOrders const* orders = nullptr; ///< of the network; required with one
};

/// Draws the terrain as a net of lines in parallel projection, with hidden lines removed and a skirt along the front,
/// and the visible parts of rivers on it. The caption states the viewing direction, the exaggeration and the size of
/// meshes.
/// \param scene a DEM of at least one cell. Cells without a height are holes in the net
/// \return the picture
/// \throws BadInput when the grid is unusable or the orders belong to another network
///
/// Source: \cite zhang, its perspective figures.
Picture wireframe(WireframeScene const& scene, WireframeParams const& params = {});

/// Chooses a viewing direction up the valley.
/// \param scene as for wireframe()
/// \return [degrees] 0 to 360: from the outlet of the longest stream to the middle of the terrain, turned if necessary
/// so that neither family of lines is seen edge-on; 30 without streams
double azimuth_up_valley(WireframeScene const& scene);

} // namespace thalweg::draw
