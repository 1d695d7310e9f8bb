// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/river_types.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/by_enum.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {
namespace {

constexpr double least = 0.001;   // for classes open below: water must flow
constexpr double greatest = 0.20; // of Aa+, open above

// In the order of the enumeration.
constexpr ByEnum<Rosgen, SlopeRange, rosgen_types.size()> slopes_of_types{{{{0.10, greatest, 0.12},
                                                                            {0.04, 0.10, 0.07},
                                                                            {0.02, 0.04, 0.03},
                                                                            {least, 0.02, 0.01},
                                                                            {least, 0.04, 0.02},
                                                                            {least, 0.005, 0.003},
                                                                            {least, 0.02, 0.01},
                                                                            {least, 0.02, 0.01},
                                                                            {0.02, 0.04, 0.03}}}};

[[noreturn]] void refuse(Arc const& arc, std::size_t number) {
    std::vector<std::string> known;
    std::string list;
    for (Rosgen const type : rosgen_types) {
        known.emplace_back(name_of(type));
        list += (list.empty() ? "" : ", ") + known.back();
    }
    Vec2 const at = arc.line.front();
    throw BadInput("network.assign_types",
                   fmt::format("'{}', the type of arc {} (feature {}) at ({:.3f}, {:.3f}), is not one of {}.{}",
                               arc.type, number + 1, arc.feature, at.x, at.y, list, did_you_mean(arc.type, known)));
}

Rosgen of_order(int order, int highest, std::vector<Rosgen> const& types) {
    auto const last = static_cast<std::int64_t>(types.size()) - 1;
    std::int64_t const steps = std::int64_t{highest} - 1;
    std::int64_t const place = steps > 0 ? (std::int64_t{2} * (order - 1) * last + steps) / (2 * steps) : last;
    return types[place];
}

} // namespace

SlopeRange slope_range(Rosgen type) {
    return slopes_of_types[type];
}

bool is_braided(Rosgen type) {
    return type == Rosgen::d || type == Rosgen::da;
}

RiverTypes assign_types(StreamNetwork const& network, NetworkOrders const& orders, AssignTypesParams const& params,
                        Run const& run) {
    refuse_if<BadParameter>(!(params.coast_m >= 0.0), "network.assign_types", "coast_m is {} m; it must be 0 or more",
                            params.coast_m);
    refuse_if<BadParameter>(params.by_order.empty(), "network.assign_types",
                            "by_order names no type; name one at least");
    require_trees(network, "network.assign_types");
    std::size_t const arcs = network.arc_count();
    bool const fits = orders.strahler.size() == arcs && orders.node_dist_out_m.size() == network.node_count() &&
                      std::ranges::all_of(orders.strahler, [](int w) { return w >= 1; });
    refuse_if<BadInput>(
        !fits, "network.assign_types",
        "the orders are not those of a network of {} arcs and {} nodes; give the orders that network.order returns",
        arcs, network.node_count());
    run.check();

    int const highest = arcs == 0 ? 1 : *std::ranges::max_element(orders.strahler);
    RiverTypes types;
    for (std::size_t a = 0; a < arcs; ++a) {
        Arc const& arc = network.arc(a);
        Rosgen type = params.one;
        if (!arc.type.empty() && arc.type != "none") {
            auto const own = rosgen_of(arc.type);
            if (!own) {
                refuse(arc, a);
            }
            type = *own;
        } else if (params.choice == TypeChoice::by_order) {
            type = of_order(orders.strahler[a], highest, params.by_order);
        }
        double const middle = orders.node_dist_out_m[network.to(a)] + 0.5 * network.length_m(a);
        types.type.push_back(type);
        types.braided.push_back(is_braided(type) || middle < params.coast_m ? 1 : 0);
    }
    return types;
}

} // namespace thalweg::network
