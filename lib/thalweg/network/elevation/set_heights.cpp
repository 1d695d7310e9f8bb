// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/set_heights.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/network/elevation/internal/raise.hpp>

namespace thalweg::network {

namespace {

/// The least slope of a repaired arc as a share of the slope asked for (specification 0.3).
constexpr double least_share = 0.01;

std::vector<double> straight_heights(StreamNetwork const& network, double slope) {
    std::vector<double> z(network.node_count(), 0.0);
    for (NodeId const n : network.upstream_order()) {
        NodeId const outlet = network.outlets()[static_cast<std::size_t>(network.basin(n) - 1)];
        z[n] = slope * distance(network.node(n).at, network.node(outlet).at);
    }
    return z;
}

/// From the outlet upwards: at least `floor`, and above the node downstream by `least_slope` along the arc.
std::vector<double> majorant(StreamNetwork const& network, std::vector<double> const& floor, double least_slope) {
    std::vector<double> z(floor);
    for (NodeId const n : network.upstream_order()) {
        if (network.out(n) == no_arc) {
            continue;
        }
        auto const arc = network.out(n);
        double const below = z[network.to(arc)];
        // A rise lost in rounding would leave the arc level.
        z[n] = std::max({floor[n], below + least_slope * network.length_m(arc), next_above(below)});
    }
    return z;
}

void report_uphill(StreamNetwork const& network, std::vector<double> const& straight, HeightReport& report) {
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        double const rise = straight[network.to(a)] - straight[network.from(a)];
        if (rise >= 0.0) {
            ++report.uphill_arcs;
            report.uphill_length_m += network.length_m(a);
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

Elevated set_heights(StreamNetwork const& network, HeightParams const& params, Run const& run) {
    require_in("network.set_heights", "slope", params.slope, Range::above(0.0), "m/m");
    require_raisable(network, "network.set_heights");
    run.check();

    Elevated raised;
    std::vector<double> const straight = straight_heights(network, params.slope);
    report_uphill(network, straight, raised.report);
    std::vector<double> z;
    switch (params.mode) {
    case HeightMode::straight: z = straight; break;
    case HeightMode::straight_repaired:
        z = majorant(network, straight, least_share * params.slope);
        report_lift(straight, z, raised.report);
        break;
    case HeightMode::along_stream: z = majorant(network, straight, params.slope); break;
    }

    raised.network = raise_linearly(network, std::move(z), "network.set_heights");
    return raised;
}

} // namespace thalweg::network
