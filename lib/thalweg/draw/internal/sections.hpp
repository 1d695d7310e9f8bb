// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/stream_network.hpp>

/// The longest stream of a network.
namespace thalweg::draw {

struct MainStem {
    std::vector<Vec2> line;         ///< [m] from the outlet upstream; empty: none
    std::vector<double> from_out_m; ///< by vertex, along the stream
};

/// The course of the main stem.
/// \param orders of this network
MainStem main_stem(StreamNetwork const& network, NetworkOrders const& orders);

} // namespace thalweg::draw
