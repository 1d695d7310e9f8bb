// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/internal/raise.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {

void require_raisable(StreamNetwork const& network, std::string_view who) {
    require_trees(network, who);
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        if (!(network.length_m(a) > 0.0)) {
            Vec2 const at = network.node(network.from(a)).at;
            throw BadInput(
                fmt::format("{}: arc {} at ({:.3f}, {:.3f}) has no length; remove it", who, a + 1, at.x, at.y));
        }
    }
}

std::vector<double> way_along(std::vector<Vec2> const& line) {
    std::vector<double> way{0.0};
    for (std::size_t i = 1; i < line.size(); ++i) {
        way.push_back(way.back() + distance(line[i - 1], line[i]));
    }
    return way;
}

std::vector<double> between(std::vector<double> const& way, double z_up, double z_down) {
    std::vector<double> z;
    double const lower = std::min(z_up, z_down);
    double const upper = std::max(z_up, z_down);
    for (double const so_far : way) {
        // Every operation is monotone in so_far, so no vertex rises; the clamp keeps the last ones above the end.
        z.push_back(std::clamp(z_up + (z_down - z_up) * (so_far / way.back()), lower, upper));
    }
    z.back() = z_down;
    return z;
}

void require_heights(StreamNetwork const& network, std::vector<double> const& node_z, std::string_view who) {
    for (std::size_t n = 0; n < node_z.size(); ++n) {
        if (!std::isfinite(node_z[n])) {
            throw BadInput(
                fmt::format("{}: the height of the node at ({}, {}) is not a finite number; the rivers below "
                            "it are too long, or too steep",
                            who, network.node(n).at.x, network.node(n).at.y));
        }
    }
}

ElevatedNetwork raise_linearly(StreamNetwork const& network, std::vector<double> node_z, std::string_view who) {
    require_heights(network, node_z, who);
    ElevatedNetwork raised{network, std::move(node_z), {}};
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        raised.arc_z.push_back(
            between(way_along(network.arc(a).line), raised.node_z[network.from(a)], raised.node_z[network.to(a)]));
    }
    return raised;
}

} // namespace thalweg::network
