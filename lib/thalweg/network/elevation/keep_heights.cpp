// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/keep_heights.hpp>

#include <thalweg/core/run/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace thalweg::network {

ElevatedNetwork keep_heights(StreamNetwork const& network, ElevatedNetwork const& known, double slope) {
    std::map<std::pair<double, double>, double> height;
    for (std::size_t a = 0; a < known.plan.arc_count(); ++a) {
        auto const& line = known.plan.arc(a).line;
        for (std::size_t i = 0; i < line.size(); ++i) {
            height[{line[i].x, line[i].y}] = known.arc_z[a][i];
        }
    }
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    auto const height_at = [&](Vec2 p) {
        auto const at = height.find({p.x, p.y});
        return at == height.end() ? none : at->second;
    };

    ElevatedNetwork out;
    out.plan = network;
    out.arc_z.resize(network.arc_count());
    for (NodeId n = 0; n < network.node_count(); ++n) {
        out.node_z.push_back(height_at(network.node(n).at));
    }
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) { // sources first
        ArcId const a = network.out(*n);
        if (a == no_arc) {
            continue;
        }
        auto const& line = network.arc(a).line;
        auto& z = out.arc_z[a];
        z.push_back(out.node_z[*n]);
        for (std::size_t i = 1; i < line.size(); ++i) {
            double const given = height_at(line[i]);
            z.push_back(std::isnan(given) ? z.back() - slope * distance(line[i - 1], line[i]) : given);
        }
        if (std::isnan(z.back())) {
            throw BadInput("network.keep_heights: a river has no height at its source; give the lines Z, or choose "
                           "another [network] heights");
        }
        double& end = out.node_z[network.to(a)];
        end = std::isnan(end) ? z.back() : std::min(end, z.back());
    }
    for (std::size_t a = 0; a < network.arc_count(); ++a) { // several arcs may carry on to one node: its lowest counts
        out.arc_z[a].back() = out.node_z[network.to(a)];
    }
    return out;
}

} // namespace thalweg::network
