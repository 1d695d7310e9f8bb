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

/// \param increments increments [m] of x = 1, 2, ...; none give empty axes that say so
/// \return the increment dh(x) and its sum H(d), as in Table 1 of Cao, Long and Lü 2009, in two diagrams.
/// \throws BadInput when an increment is not finite
Picture curve(std::vector<double> const& increments, CurveParams const& params = {});

/// Options of profile().
struct ProfileParams {
    int width_px = 1000; ///< [200, 8000]
    int height_px = 560; ///< [200, 8000]
    Format format = Format::svg;
    std::string title; ///< "" for none
};

/// \pre a network and its orders; arcs that reach no outlet are left out. Without any, empty axes that say so.
/// \param network the network
/// \param orders the network's orders
/// \return long profiles: height against distance from the outlet along the water of every arc, main stems (Hack 1)
/// emphasised.
/// \throws BadInput when orders or heights are not those of the network, or a number is not finite
Picture profile(ElevatedNetwork const& network, NetworkOrders const& orders, ProfileParams const& params = {});

/// Options of hypsometry().
struct HypsometryParams {
    std::string title;   ///< what the land is, before the integral; "" for none
    int width_px = 1000; ///< [200, 8000]
    int height_px = 640; ///< [200, 8000]
    Format format = Format::svg;
};

/// \param curve x = share of the area above [0, 1], y = height [m], by rising or falling height; none gives empty axes
/// that say so
/// \param integral [0, 1], or NaN where it is not defined (one height)
/// \return the hypsometric curve: height over the share of the area that lies above it, with its integral.
/// \throws BadInput when a number is not finite or a share lies outside [0, 1]
///
/// Source: \cite strahler1952.
Picture hypsometry(std::vector<Vec2> const& curve, double integral, HypsometryParams const& params = {});

} // namespace thalweg::draw
