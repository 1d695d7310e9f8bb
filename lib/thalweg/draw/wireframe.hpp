// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/draw/picture.hpp>

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
