// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/rosgen.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: Rosgen's classification names reaches by form, and each type has a usual range of slopes
// (Aa+ above 10 %, C below 2 %). Types thus stand for slopes where no heights are known: a user
// writes letters on lines, or they follow from Strahler's order, steep types for headwaters and
// gentle ones for trunks. Types D and DA, and reaches near the coast, are braided.
// Source: Rosgen 1994, as in Northeast Normal University 2015, section 3 and table 2; classes that
// the table leaves open end at 0.1 % and 20 %.
// Cost: O(arcs). One thread.
// Not for: classifying real reaches, which needs entrenchment, width, sinuosity and bed material.
// Where drainage areas are known, set_heights_graded (set_heights.hpp) is smoother: types step from
// arc to arc.
// Example:
//     RiverTypes const types = assign_types(network, order(network), {.coast_m = 2000.0});
//     ElevatedNetwork const rivers = set_heights_by_type(network, types); // set_heights.hpp
// More: docs/rivers.md, "Heights of rivers".

namespace thalweg::network {

/// The range of channel slopes of a river type. Law: 0 < low < high, low <= usual <= high. Classes that the table
/// leaves open end at 0.001 below and 0.2 above. Source: Rosgen 1994; \cite nenu2015, table 2.
struct SlopeRange {
    double low = 0.0;   ///< [m/m]
    double high = 0.0;  ///< [m/m]
    double usual = 0.0; ///< [m/m] the class's typical slope
};
SlopeRange slope_range(Rosgen type);

/// Tells whether rivers of a type are braided.
/// \param type any type
/// \return true: D and DA
bool is_braided(Rosgen type);

/// How arcs without a type of their own get one.
enum class TypeChoice : std::uint8_t {
    one,     ///< one type for all
    by_order ///< by Strahler order
};

/// Options of assign_types().
struct AssignTypesParams {
    TypeChoice choice = TypeChoice::by_order;
    Rosgen one = Rosgen::c; ///< for TypeChoice::one
    /// For TypeChoice::by_order: at least one, from the network's lowest order to its highest.
    std::vector<Rosgen> by_order = {Rosgen::aa_plus, Rosgen::a, Rosgen::b, Rosgen::c};
    double coast_m = 0.0; ///< [m] >= 0, arcs whose middle is nearer to the outlet along the stream are braided
};

/// Rosgen's river type of every arc.
struct RiverTypes {
    std::vector<Rosgen> type;
    std::vector<std::uint8_t> braided; ///< 1: several channels, 0: one
};

/// Assigns river types: the arc's own (Arc::type, except "none"), or by params.choice.
/// \param network a forest
/// \param orders orders of this network
/// \return by order: with n types and orders 1 ... W, order w has the type at index round((w - 1) / (W - 1) (n - 1)),
/// half up; the highest order has the last type, even if it is 1. D, DA and arcs near the coast are braided; the coast
/// changes no type.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput naming the arc, its feature and position for an unknown type; for orders of another network
///
/// Source: \cite nenu2015, section 3 and table 2.
RiverTypes assign_types(StreamNetwork const& network, NetworkOrders const& orders, AssignTypesParams const& params = {},
                        Run const& run = {});

} // namespace thalweg::network
