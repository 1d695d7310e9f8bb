// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::pipeline {

enum class PictureKind : std::uint8_t { map, profile, curve, hypsometry, sections, wireframe };

/// \return every kind, in the order of the enumeration.
std::vector<PictureKind> const& picture_kinds();
char const* name_of(PictureKind kind);

/// What there is to draw; what is missing is empty.
struct Scene {
    std::optional<Raster<float>> dem;
    std::optional<ElevatedNetwork> network;
    NetworkOrders orders;           ///< of the network
    std::vector<double> ds_area_m2; ///< drained by each arc, not above 0: not known; empty: of none
    std::vector<double> increments; ///< [m] of the surface, as used
    std::string increment;          ///< its name or expression
    std::string title;
    double contour_interval_m = 0.0; ///< 0 chooses a round number
};

/// How it is drawn; what is left out is chosen by each picture.
struct Look {
    draw::Format format = draw::Format::png;
    int width_px = 0;
    std::optional<double> azimuth_deg;   ///< of the wireframe, as the others; without it up-valley from the outlet
    std::optional<double> elevation_deg; ///< of the eye above the horizon
    std::optional<double> exaggeration;
};

/// \param kind kind of picture
/// \param scene what is drawn
/// \return why a picture cannot be drawn of a scene, in words that end a sentence; "" where it can.
std::string missing_for(PictureKind kind, Scene const& scene);

/// Draws one picture of a scene.
/// \param scene what is drawn
/// \return the picture
/// \throws BadInput when something is missing for it; what the pictures throw
draw::Picture draw_picture(PictureKind kind, Scene const& scene, Look const& look, Run const& run = {});

/// \param relief_m [m] > 0, height range
/// \return a round contour interval (1, 2 or 5 times a power of ten) that gives about twenty contours.
double round_interval(double relief_m);

} // namespace thalweg::pipeline
