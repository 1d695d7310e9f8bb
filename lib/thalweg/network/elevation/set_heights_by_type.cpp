// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/set_heights_by_type.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/chance.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/elevation/internal/raise.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t slope_stage = 0x736c6f7065627974; // "slopebyt"

double slope_at(Vec2 place, Rosgen type, HeightsByTypeParams const& params) {
    SlopeRange const range = slope_range(type);
    if (params.draw == SlopeDraw::middle) {
        return range.usual;
    }
    // Added to 0, the zero of either sign is the same place.
    auto const word = chance(params.seed, slope_stage, std::bit_cast<std::uint64_t>(place.x + 0.0),
                             std::bit_cast<std::uint64_t>(place.y + 0.0));
    return std::min(range.low + (range.high - range.low) * unit(word), range.high);
}

} // namespace

RaisedNetwork set_heights_by_type(StreamNetwork const& network, RiverTypes const& types,
                                  HeightsByTypeParams const& params, Run const& run) {
    NetworkIndex const index(network);
    require_raisable(network, index, "network.set_heights_by_type");
    if (types.type.size() != index.arcs.size()) {
        throw BadInput(fmt::format(
            "network.set_heights_by_type: {} types for {} arcs; give the types that network.assign_types returns",
            types.type.size(), index.arcs.size()));
    }
    run.check();

    std::vector<double> z(index.out.size(), 0.0);
    for (NodeId const n : index.upstream_order) {
        if (index.out[n] >= 0) {
            auto const a = static_cast<std::size_t>(index.out[n]);
            double const below = z[index.to[a]];
            double const slope = slope_at(network[n].at, types.type[a], params);
            // A rise lost in rounding would leave the arc level.
            z[n] = std::max(below + slope * index.length_m[a], next_above(below));
        }
    }
    return raise_linearly(network, index, std::move(z), "network.set_heights_by_type");
}

} // namespace thalweg::network
