// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/make/line_sources.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/order/order.hpp>

namespace thalweg::make {

/// Rivers with heights, and what follows from them.
struct Rivers {
    ElevatedNetwork network = {};
    network::RiverTypes types = {}; ///< by arc; empty where the recipe asks for none
    NetworkOrders orders = {};
    network::StreamCounts streams = {};
    RiverClues clues = {}; ///< of their file
};

/// \param network rivers with heights
/// \param types by arc, or empty
/// \param clues of the file of the rivers; those of main stems: name, class or area, else the longest flow path
/// \return the rivers with their orders and streams
Rivers rivers_of(ElevatedNetwork network, network::RiverTypes types, RiverClues clues);

/// Orders rivers whose arcs may come from a file, by its clues.
NetworkOrders order_rivers(StreamNetwork const& network, RiverClues const& clues);

/// How heights were assigned to rivers.
struct HeightsStatistics {
    network::HeightReport repair = {}; ///< under modes that set heights
    std::int64_t lowered_cells = 0;    ///< shared valley cells lowered so that every flow path descends
    double max_lowered_m = 0.0;
};

} // namespace thalweg::make
