// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/internal/hack.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::measure {

std::optional<PowerLaw> hack(StreamNetwork const& network, std::vector<double> const& ds_area_m2,
                             std::vector<double> const& head_m, PowerLawParams const& params) {
    NetworkIndex const index(network);
    std::size_t const nodes = index.out.size();
    if (ds_area_m2.size() != index.arcs.size() || (!head_m.empty() && head_m.size() != nodes)) {
        throw BadInput(fmt::format("measure.hack: {} areas for {} arcs and {} heads for {} nodes; measure the network "
                                   "again",
                                   ds_area_m2.size(), index.arcs.size(), head_m.size(), nodes));
    }
    std::vector<double> longest(nodes, 0.0); // way of water above a node
    std::vector<AtArea> ends(index.arcs.size());
    for (auto n = index.upstream_order.rbegin(); n != index.upstream_order.rend(); ++n) {
        if (index.in[*n].empty() && !head_m.empty()) {
            longest[*n] = head_m[*n];
        }
        if (index.out[*n] >= 0) {
            auto const a = static_cast<std::size_t>(index.out[*n]);
            double const length = longest[*n] + index.length_m[a];
            longest[index.to[a]] = std::max(longest[index.to[a]], length);
            ends[a] = {ds_area_m2[a], length};
        }
    }
    return fit_power_law(ends, params);
}

} // namespace thalweg::measure
