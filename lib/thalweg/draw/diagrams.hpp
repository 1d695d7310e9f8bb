// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

/// Options of curve().
struct CurveParams {
    std::string increment; ///< its name or expression, for the title
    int width_px = 1000;   ///< [200, 8000]
    int height_px = 560;   ///< [200, 8000]
    Format format = Format::svg;
};

/// Draws the increment dh(x) and its sum H(d) in two diagrams, as in Table 1 of Cao, Long and Lü 2009.
/// \param increments increments [m] of x = 1, 2, ...; empty: empty axes that say so
/// \return the picture
/// \throws BadInput when an increment is not finite
Picture curve(std::vector<double> const& increments, CurveParams const& params = {});

/// Options of profile().
struct ProfileParams {
    int width_px = 1000; ///< [200, 8000]
    int height_px = 560; ///< [200, 8000]
    Format format = Format::svg;
    std::string title; ///< "" for none
};

/// Draws the long profile of the main stem: height against distance along the water from the outlet, with the streams
/// of its basin as thin lines and a tick at every confluence.
/// \param network without a main stem: empty axes that say so
/// \param orders the network's orders
/// \return the picture
/// \throws BadInput when orders or heights are not those of the network, or a number is not finite
Picture profile(ElevatedNetwork const& network, NetworkOrders const& orders, ProfileParams const& params = {});

/// Options of hypsometry().
struct HypsometryParams {
    std::string title;   ///< description of the terrain, before the integral; "" for none
    int width_px = 1000; ///< [200, 8000]
    int height_px = 640; ///< [200, 8000]
    Format format = Format::svg;
};

/// Draws the hypsometric curve: height over the share of the area above it, with its integral.
/// \param curve x = share of the area above [0, 1], y = height [m], by ascending or descending height; empty: empty
/// axes that say so
/// \param integral [0, 1]; NaN: undefined (one height)
/// \return the picture
/// \throws BadInput when a number is not finite or a share is outside [0, 1]
///
/// Source: \cite strahler1952.
Picture hypsometry(std::vector<Vec2> const& curve, double integral, HypsometryParams const& params = {});

} // namespace thalweg::draw
