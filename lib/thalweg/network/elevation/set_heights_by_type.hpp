// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/elevation/assign_types.hpp>

namespace thalweg::network {

/// How an arc's slope is chosen from its type's range.
enum class SlopeDraw : std::uint8_t {
    middle, ///< the class's typical slope (SlopeRange::usual)
    uniform ///< random, uniform over the range
};

/// Options of set_heights_by_type().
struct HeightsByTypeParams {
    SlopeDraw draw = SlopeDraw::middle;
    std::uint64_t seed = 0; ///< random seed, for SlopeDraw::uniform
};

/// Assigns heights above the outlet (z = 0) from the slopes of river types; vertices are interpolated by length.
/// \param network a forest
/// \param types by arc
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return an arc falls by a slope from its type's range times its length. Random slopes are a hash of the seed and the
/// position of the arc's upper end.
/// \throws BadInput for an arc of length 0, a network that is not a forest, or types of another network
///
/// Source: \cite nenu2015, section 3 and table 2; specification 3.3.
ElevatedNetwork set_heights_by_type(StreamNetwork const& network, RiverTypes const& types,
                                    HeightsByTypeParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
