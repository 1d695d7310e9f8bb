// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::measure {

/// The streams of one Strahler order. A stream is a longest chain of arcs of equal order, not an arc.
struct StreamOrder {
    int order = 1;
    std::int64_t streams = 0;
    double length_m = 0.0; ///< [m] mean over the streams
    double area_m2 = 0.0;  ///< [m2] mean drainage area at the streams' downstream ends
};

/// By what factor something changes from an order to the next.
struct HortonRatio {
    double ratio = 0.0;
    double r2 = 0.0;         ///< of the line through the logarithms; NaN of two, or where all are one
    std::int64_t orders = 0; ///< that have a logarithm
};

/// The laws of drainage composition: by what factor streams change from an order to the next.
struct HortonLaws {
    std::vector<StreamOrder> orders;        ///< 1, 2, ... to the highest
    std::optional<HortonRatio> bifurcation; ///< R_B: streams of an order for one of the next
    std::optional<HortonRatio> length;      ///< R_L: mean length against that of the order below
    std::optional<HortonRatio> area;        ///< R_A: mean drainage area against that of the order below
};

/// Counts, lengths and areas of streams by Strahler order, and their ratios.
/// \pre a network of trees with its Strahler orders
/// \param network the network
/// \param orders the network's orders
/// \param ds_area_m2 by arc, the area at its downstream end
/// \return a ratio is e to the slope (R_B: to its negative) of the straight line fitted by least squares to the natural
/// logarithm over the order, with every order counting once, the highest and so perhaps cut one too. An order of mean 0
/// has no logarithm and is left out; with fewer than two orders there is no ratio.
/// \throws BadInput when orders or areas are not one an arc, or an order is below 1
///
/// Source: \cite horton1945 (laws of stream numbers and lengths); \cite schumm1956 (areas); \cite strahler1957 (streams
/// as chains of equal order; the regression).
HortonLaws horton(StreamNetwork const& network, NetworkOrders const& orders, std::vector<double> const& ds_area_m2);

} // namespace thalweg::measure
