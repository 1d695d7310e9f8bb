// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/set_heights_by_type.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/random.hpp>
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
    auto const word = random_word(params.seed, slope_stage, std::bit_cast<std::uint64_t>(place.x + 0.0),
                                  std::bit_cast<std::uint64_t>(place.y + 0.0));
    return std::min(range.low + (range.high - range.low) * unit(word), range.high);
}

} // namespace

ElevatedNetwork set_heights_by_type(StreamNetwork const& network, RiverTypes const& types,
                                    HeightsByTypeParams const& params, Run const& run) {
    require_raisable(network, "network.set_heights_by_type");
    if (types.type.size() != network.arc_count()) {
        throw BadInput(fmt::format(
            "network.set_heights_by_type: {} types for {} arcs; give the types that network.assign_types returns",
            types.type.size(), network.arc_count()));
    }
    run.check();

    std::vector<double> z(network.node_count(), 0.0);
    for (NodeId const n : network.upstream_order()) {
        if (network.out(n) != no_arc) {
            auto const a = network.out(n);
            double const below = z[network.to(a)];
            double const slope = slope_at(network.node(n).at, types.type[a], params);
            // A rise lost in rounding would leave the arc level.
            z[n] = std::max(below + slope * network.length_m(a), next_above(below));
        }
    }
    return raise_linearly(network, std::move(z), "network.set_heights_by_type");
}

} // namespace thalweg::network
