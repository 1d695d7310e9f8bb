// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/drape.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {

namespace {

double height_at(Raster<float> const& dem, Vec2 p) {
    Cell const cell = dem.grid().cell_of(p);
    float const z = dem.grid().contains(cell) ? dem[cell] : std::nanf("");
    if (!std::isfinite(z)) {
        throw BadInput(fmt::format("network.drape: the DEM has no height at ({:.3f}, {:.3f}), where a river runs; give "
                                   "one that covers the network",
                                   p.x, p.y));
    }
    return static_cast<double>(z);
}

} // namespace

ElevatedNetwork drape(StreamNetwork const& network, Raster<float> const& dem) {
    require_trees(network, "network.drape");
    ElevatedNetwork raised{network, {}, {}};
    raised.arc_z.resize(network.arc_count());
    for (NodeId n = 0; n < network.node_count(); ++n) {
        raised.node_z.push_back(height_at(dem, network.node(n).at));
    }
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) { // sources first
        ArcId const a = network.out(*n);
        if (a == no_arc) {
            continue;
        }
        double z = raised.node_z[*n];
        for (Vec2 const p : network.arc(a).line) {
            z = std::min(z, height_at(dem, p));
            raised.arc_z[a].push_back(z);
        }
        double& end = raised.node_z[network.to(a)];
        end = std::min(end, z);
    }
    for (std::size_t a = 0; a < network.arc_count(); ++a) { // another arc may have come to the node lower
        raised.arc_z[a].back() = raised.node_z[network.to(a)];
    }
    return raised;
}

} // namespace thalweg::network
