// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/internal/hack.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::measure {

std::optional<PowerLaw> hack(StreamNetwork const& network, std::vector<double> const& ds_area_m2,
                             std::vector<double> const& head_m, PowerLawParams const& params) {
    std::size_t const nodes = network.node_count();
    if (ds_area_m2.size() != network.arc_count() || (!head_m.empty() && head_m.size() != nodes)) {
        throw BadInput(fmt::format("measure.hack: {} areas for {} arcs and {} heads for {} nodes; measure the network "
                                   "again",
                                   ds_area_m2.size(), network.arc_count(), head_m.size(), nodes));
    }
    std::vector<double> longest(nodes, 0.0); // way of water above a node
    std::vector<AtArea> ends(network.arc_count());
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) {
        if (network.in(*n).empty() && !head_m.empty()) {
            longest[*n] = head_m[*n];
        }
        if (network.out(*n) != no_arc) {
            auto const a = network.out(*n);
            double const length = longest[*n] + network.length_m(a);
            longest[network.to(a)] = std::max(longest[network.to(a)], length);
            ends[a] = {ds_area_m2[a], length};
        }
    }
    return fit_power_law(ends, params);
}

} // namespace thalweg::measure
