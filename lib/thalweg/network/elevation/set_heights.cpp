// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/set_heights.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/elevation/internal/raise.hpp>

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
    std::vector<double> z(floor);
    for (NodeId const n : index.upstream_order) {
        if (index.out[n] < 0) {
            continue;
        }
        auto const arc = static_cast<std::size_t>(index.out[n]);
        double const below = z[index.to[arc]];
        // A rise lost in rounding would leave the arc level.
        z[n] = std::max({floor[n], below + least_slope * index.length_m[arc], next_above(below)});
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

} // namespace

Raised set_heights(StreamNetwork const& network, HeightParams const& params, Run const& run) {
    if (!(params.slope > 0.0) || !std::isfinite(params.slope)) {
        throw BadParameter(
            fmt::format("network.set_heights: slope is {} m/m; it must be a number above 0", params.slope));
    }
    NetworkIndex const index(network);
    require_raisable(network, index, "network.set_heights");
    run.check();

    Raised raised;
    std::vector<double> const straight = straight_heights(network, index, params.slope);
    report_uphill(index, straight, raised.report);
    std::vector<double> z;
    switch (params.mode) {
    case HeightMode::straight: z = straight; break;
    case HeightMode::straight_repaired:
        z = majorant(index, straight, least_share * params.slope);
        report_lift(straight, z, raised.report);
        break;
    case HeightMode::along_stream: z = majorant(index, straight, params.slope); break;
    }

    raised.network = raise_linearly(network, index, std::move(z), "network.set_heights");
    return raised;
}

} // namespace thalweg::network
