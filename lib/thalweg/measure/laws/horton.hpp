// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::measure {

/// The streams of one Strahler order: maximal chains of arcs of equal order.
struct StreamOrder {
    int order = 1;
    std::int64_t streams = 0;
    double length_m = 0.0; ///< [m] mean
    double area_m2 = 0.0;  ///< [m2] mean drainage area at downstream ends
};

/// A ratio of consecutive orders.
struct HortonRatio {
    double ratio = 0.0;
    double r2 = 0.0;         ///< of the regression of logarithms; NaN: two orders, or all equal
    std::int64_t orders = 0; ///< number of orders in the regression
};

/// Horton's laws of drainage composition.
struct HortonLaws {
    std::vector<StreamOrder> orders;        ///< 1, 2, ... to the highest
    std::optional<HortonRatio> bifurcation; ///< R_B: number of streams, order to the next
    std::optional<HortonRatio> length;      ///< R_L: mean length, order to the one below
    std::optional<HortonRatio> area;        ///< R_A: mean drainage area, order to the one below
};

/// Computes number, length and area of streams by Strahler order, and Horton's ratios: exp of the slope (R_B: of its
/// negative) of the least-squares line of natural logarithms over order, all orders with equal weight.
/// \param network a forest
/// \param orders orders of this network
/// \param ds_area_m2 [m2] by arc: area at its downstream end
/// \return an order of mean 0 is left out; with fewer than two orders there is no ratio
/// \throws BadInput when there is not one order and area per arc, or an order is below 1
///
/// Source: \cite horton1945 (laws of stream numbers and lengths); \cite schumm1956 (areas); \cite strahler1957 (streams
/// as chains of equal order; the regression).
HortonLaws horton(StreamNetwork const& network, NetworkOrders const& orders, std::vector<double> const& ds_area_m2);

} // namespace thalweg::measure
