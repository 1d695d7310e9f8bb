// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/elevation/rosgen.hpp>

namespace thalweg::network {

/// What decides the type of an arc that brings none of its own.
enum class TypeChoice : std::uint8_t {
    one,     ///< one type for all
    by_order ///< its Strahler order
};

/// Options of assign_types().
struct AssignTypesParams {
    TypeChoice choice = TypeChoice::by_order;
    Rosgen one = Rosgen::c; ///< under one
    /// Under by_order: from the lowest order to the highest of the network, at least one.
    std::vector<Rosgen> by_order = {Rosgen::aa_plus, Rosgen::a, Rosgen::b, Rosgen::c};
    double coast_m = 0.0; ///< [m] >= 0: arcs whose middle is nearer to the outlet along the stream are braided
};

/// The type of every arc, by its number.
struct RiverTypes {
    std::vector<Rosgen> type;
    std::vector<std::uint8_t> braided; ///< 1 where the river runs in several channels, else 0
};

/// Gives every arc a type of river: the one it brings (Arc::type; "none" is none), or one by choice.
/// \pre a network whose components are trees; its orders.
/// \param network the network
/// \param orders the network's orders
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return under by_order, of n types and orders 1 to W, order w has the type of the place nearest to (w - 1) / (W - 1)
/// (n - 1) counted from 0, halves upwards; the highest order, also where it is 1, has the last. Braided are D, DA and
/// what lies near the coast; that changes no type.
/// \throws BadParameter
/// \throws BadInput naming the arc, its feature and place for an unknown type, or when the orders are another network's
///
/// Source: \cite nenu2015, section 3 and table 2; specification 3.3.
RiverTypes assign_types(StreamNetwork const& network, NetworkOrders const& orders, AssignTypesParams const& params = {},
                        Run const& run = {});

} // namespace thalweg::network
