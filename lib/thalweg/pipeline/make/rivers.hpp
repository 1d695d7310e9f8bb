// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/order/order.hpp>

namespace thalweg::pipeline {

/// Rivers with heights, and what follows from them.
struct Rivers {
    ElevatedNetwork network;
    network::RiverTypes types; ///< by arc; empty where the recipe asks for none
    NetworkOrders orders;
    network::StreamCounts streams;
};

/// \param network rivers with heights
/// \param types by arc, or empty
/// \return the rivers with their orders and streams
Rivers rivers_of(ElevatedNetwork network, network::RiverTypes types);

/// How heights were assigned to rivers.
struct HeightsStatistics {
    network::HeightReport repair = {}; ///< under modes that set heights
    std::int64_t lowered_cells = 0;    ///< shared valley cells lowered so that every flow path descends
    double max_lowered_m = 0.0;
};

} // namespace thalweg::pipeline
