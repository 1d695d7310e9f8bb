// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/elevation/assign_types.hpp>

namespace thalweg::network {

/// Which slope of its type's range an arc gets.
enum class SlopeDraw : std::uint8_t {
    middle, ///< the one that stands for the class (SlopeRange::usual)
    uniform ///< one at random, every slope of the range alike
};

/// Options of set_heights_by_type().
struct HeightsByTypeParams {
    SlopeDraw draw = SlopeDraw::middle;
    std::uint64_t seed = 0; ///< of uniform
};

/// Gives every node its height above the outlet (z = 0) by the slopes of its rivers' types.
/// \pre a network whose components are trees; the types of its arcs.
/// \param network the network
/// \param types by arc, type of river
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return z_up = z_down + slope of the arc's type times its length, the slope within the type's range; under uniform
/// it belongs to the seed and the place of the arc's upper end. Every arc falls strictly; vertices are linear by
/// length.
/// \throws BadInput for an arc of no length, a network that is not a forest, or types of another network
///
/// Source: \cite nenu2015, section 3 and table 2; specification 3.3.
ElevatedNetwork set_heights_by_type(StreamNetwork const& network, RiverTypes const& types,
                                    HeightsByTypeParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
