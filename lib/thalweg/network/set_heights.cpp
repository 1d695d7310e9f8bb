// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/set_heights.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>
#include <thalweg/network/require_trees.hpp>

namespace thalweg::network {

namespace {

/// The least slope of a repaired arc as a share of the slope asked for (specification 0.3).
constexpr double least_share = 0.01;

std::vector<double> straight_heights(StreamNetwork const& network, NetworkIndex const& index, double slope) {
    std::vector<double> z(index.out.size(), 0.0);
    for (NodeId const n : index.upstream_order) {
        NodeId const outlet = index.outlets[static_cast<std::size_t>(index.basin[n] - 1)];
        z[n] = slope * distance(network[n].at, network[outlet].at);
    }
    return z;
}

/// From the outlet upwards: at least `floor`, and above the node downstream by `least_slope` along the arc.
std::vector<double> majorant(NetworkIndex const& index, std::vector<double> const& floor, double least_slope) {
    constexpr double next_above = 1.0 + 0x1p-52;
    std::vector<double> z(floor);
    for (NodeId const n : index.upstream_order) {
        if (index.out[n] < 0) {
            continue;
        }
        auto const arc = static_cast<std::size_t>(index.out[n]);
        double const below = z[index.to[arc]];
        // A rise lost in rounding would leave the arc level.
        z[n] = std::max({floor[n], below + least_slope * index.length_m[arc], below * next_above});
    }
    return z;
}

void report_uphill(NetworkIndex const& index, std::vector<double> const& straight, HeightReport& report) {
    for (std::size_t a = 0; a < index.arcs.size(); ++a) {
        double const rise = straight[index.to[a]] - straight[index.from[a]];
        if (rise >= 0.0) {
            ++report.uphill_arcs;
            report.uphill_length_m += index.length_m[a];
            report.max_rise_m = std::max(report.max_rise_m, rise);
        }
    }
}

void report_lift(std::vector<double> const& straight, std::vector<double> const& z, HeightReport& report) {
    double squares = 0.0;
    for (std::size_t n = 0; n < z.size(); ++n) {
        if (double const lift = z[n] - straight[n]; lift > 0.0) {
            ++report.lifted;
            report.max_lift_m = std::max(report.max_lift_m, lift);
            squares += lift * lift;
        }
    }
    if (report.lifted > 0) {
        report.rms_lift_m = std::sqrt(squares / static_cast<double>(report.lifted));
    }
}

/// Heights of a line's vertices between those of its ends, linear by length.
std::vector<double> along(std::vector<Vec2> const& line, double length_m, double z_up, double z_down) {
    std::vector<double> z(line.size(), z_up);
    double const lower = std::min(z_up, z_down);
    double const upper = std::max(z_up, z_down);
    double so_far = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        so_far += distance(line[i - 1], line[i]);
        // Every operation is monotone in so_far, so no vertex rises; the clamp keeps the last ones above the end.
        z[i] = std::clamp(z_up + (z_down - z_up) * (so_far / length_m), lower, upper);
    }
    z.back() = z_down;
    return z;
}

} // namespace

Raised set_heights(StreamNetwork const& network, HeightParams const& params, Run const& run) {
    if (!(params.slope > 0.0) || !std::isfinite(params.slope)) {
        throw BadParameter(
            fmt::format("network.set_heights: slope is {} m/m; it must be a number above 0", params.slope));
    }
    NetworkIndex const index(network);
    require_trees(network, index, "network.set_heights");
    for (std::size_t a = 0; a < index.arcs.size(); ++a) {
        if (!(index.length_m[a] > 0.0)) {
            Vec2 const at = network[index.from[a]].at;
            throw BadInput(fmt::format("network.set_heights: arc {} at ({:.3f}, {:.3f}) has no length; remove it",
                                       a + 1, at.x, at.y));
        }
    }
    run.check();

    Raised raised;
    std::vector<double> const straight = straight_heights(network, index, params.slope);
    report_uphill(index, straight, raised.report);
    std::vector<double>& z = raised.network.node_z;
    switch (params.mode) {
    case HeightMode::straight: z = straight; break;
    case HeightMode::straight_repaired:
        z = majorant(index, straight, least_share * params.slope);
        report_lift(straight, z, raised.report);
        break;
    case HeightMode::along_stream: z = majorant(index, straight, params.slope); break;
    }

    raised.network.plan = network;
    for (std::size_t a = 0; a < index.arcs.size(); ++a) {
        raised.network.arc_z.push_back(
            along(network[index.arcs[a]].line, index.length_m[a], z[index.from[a]], z[index.to[a]]));
    }
    return raised;
}

} // namespace thalweg::network
