// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

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
/// \param params options, each with its default, unit and range
/// \return long profiles: height against distance from the outlet along the water of every arc, main stems (Hack 1)
/// emphasised.
/// \throws BadParameter
/// \throws BadInput when orders or heights are not those of the network, or a number is not finite
Picture profile(ElevatedNetwork const& network, NetworkOrders const& orders, ProfileParams const& params = {});

} // namespace thalweg::draw
