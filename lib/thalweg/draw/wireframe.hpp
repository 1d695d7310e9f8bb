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
    double azimuth_deg = 30.0;   ///< any; the bearing one looks along, clockwise from north
    double elevation_deg = 32.0; ///< [5, 85] of the eye above the horizon
    double exaggeration = 0.0;   ///< [0, 1e6] of heights; 0 chooses a round number that reads well
    int lines = 60;              ///< [2, 200] at most, each way
    int width_px = 1200;         ///< [200, 8000]; the height follows
    Format format = Format::svg;
};

/// What a wireframe shows.
struct WireframeScene {
    Raster<float> const& dem;
    ElevatedNetwork const* network = nullptr;
    NetworkOrders const* orders = nullptr; ///< of the network; needed where there is one
};

/// The caption says from where, with which exaggeration and how wide the meshes are.
/// \param scene a DEM of one cell or more. Cells without a height are holes in the net
/// \return a net of lines over the land in parallel projection, hidden lines removed, with a skirt along the front;
/// rivers, laid on the net, where they are seen.
/// \throws BadInput when the grid is unusable or orders are of another network
///
/// Source: \cite zhang, its perspective figures.
Picture wireframe(WireframeScene const& scene, WireframeParams const& params = {});

/// \param scene what is drawn
/// \return the bearing [degrees, 0 to 360] from the outlet of the longest stream to the middle of the land, turned
/// where needed so that neither family of lines is seen end on; 30 without streams.
double azimuth_up_valley(WireframeScene const& scene);

} // namespace thalweg::draw
