// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/network/order/order.hpp>

/// A small network with everything its tables hold, numbers that do not end in binary among them.
struct SampleNetwork {
    thalweg::NetworkDraft draft; ///< settle() makes the network's plan from it
    thalweg::ElevatedNetwork network;
    thalweg::NetworkOrders orders;
    std::vector<double> us_area_m2;
    std::vector<double> ds_area_m2;
    std::vector<double> node_area_m2;

    thalweg::io::NetworkTables tables(std::string const& crs = "EPSG:32631") const {
        return {network, orders, us_area_m2, ds_area_m2, node_area_m2, crs, {{"version", "0.1.0"}, {"seed", "7"}}};
    }

    thalweg::NodeId node(double x, double y, double z) {
        network.node_z.push_back(z);
        return draft.add_node({x, y});
    }

    /// An arc that falls evenly by vertex, through some positions.
    void arc(thalweg::NodeId from, thalweg::NodeId to, std::vector<thalweg::Vec2> through = {}) {
        thalweg::Arc arc;
        arc.line.push_back({});
        arc.line.insert(arc.line.end(), through.begin(), through.end());
        arc.line.push_back({});
        std::vector<double> z;
        for (std::size_t i = 0; i < arc.line.size(); ++i) {
            double const share = static_cast<double>(i) / static_cast<double>(arc.line.size() - 1);
            z.push_back(network.node_z[from] * (1.0 - share) + network.node_z[to] * share);
        }
        z.front() = network.node_z[from];
        z.back() = network.node_z[to];
        network.arc_z.push_back(z);
        draft.add_arc(from, to, std::move(arc));
    }

    /// Fills orders, and areas that grow downstream.
    void settle() {
        network.planform = draft;
        thalweg::StreamNetwork const& plan = network.planform;
        orders = thalweg::network::order(plan);
        us_area_m2.assign(plan.arc_count(), 0.1);
        ds_area_m2.assign(plan.arc_count(), 0.0);
        node_area_m2.assign(plan.node_count(), 0.1);
        for (auto n = plan.upstream_order().rbegin(); n != plan.upstream_order().rend(); ++n) {
            if (plan.out(*n) == thalweg::no_arc && !plan.in(*n).empty()) {
                node_area_m2[*n] = 0.0; // its cell belongs to an arc that enters it
            }
            for (thalweg::ArcId const above : plan.in(*n)) {
                node_area_m2[*n] += ds_area_m2[above];
            }
            if (thalweg::ArcId const a = plan.out(*n); a != thalweg::no_arc) {
                us_area_m2[a] = node_area_m2[*n];
                ds_area_m2[a] = us_area_m2[a] + plan.length_m(a);
            }
        }
    }
};

/// A network with orders and areas of its own.
inline SampleNetwork sample_of(thalweg::ElevatedNetwork network) {
    SampleNetwork sample;
    sample.draft = network.planform.draft();
    sample.network = std::move(network);
    sample.settle();
    return sample;
}

inline SampleNetwork single_arc() {
    SampleNetwork sample;
    auto const source = sample.node(500000.1, 4000000.2, 12.3);
    auto const outlet = sample.node(500100.7, 4000000.2, 0.1);
    sample.arc(source, outlet, {{500033.3, 4000010.1}, {500066.6, 3999990.9}});
    sample.settle();
    return sample;
}

/// Two sources, a confluence, an outlet.
inline SampleNetwork y_shape() {
    SampleNetwork sample;
    auto const outlet = sample.node(0.1, 0.2, 1.0 / 3.0);
    auto const confluence = sample.node(0.3, 100.7, 4.7);
    auto const left = sample.node(-70.7, 180.9, 11.1);
    auto const right = sample.node(90.9, 170.1, 9.9);
    sample.arc(left, confluence, {{-40.4, 150.1}});
    sample.arc(confluence, outlet);
    sample.arc(right, confluence, {{60.6, 130.3}, {30.3, 120.2}});
    sample.settle();
    return sample;
}

/// A basin with a confluence of three and a pseudo node, and another of one arc with a type and a survival threshold.
inline SampleNetwork two_basins() {
    SampleNetwork sample;
    auto const mouth = sample.node(0.0, 0.0, 0.0);
    auto const pseudo = sample.node(0.5, 50.5, 1.0);
    auto const three = sample.node(0.7, 100.1, 2.0);
    auto const up = sample.node(0.9, 250.2, 7.0);
    auto const west = sample.node(-100.3, 100.4, 5.0);
    auto const east = sample.node(100.6, 100.8, 6.0);
    auto const other_mouth = sample.node(1000.1, 0.0, 3.0);
    auto const other_source = sample.node(1000.1, 99.9, 3.0);
    sample.arc(up, three);
    sample.arc(west, three);
    sample.arc(east, three);
    sample.arc(three, pseudo);
    sample.arc(pseudo, mouth);
    sample.arc(other_source, other_mouth);
    auto& arc = sample.draft.arcs.back().arc;
    arc.type = "Bärenbach";
    arc.feature = 123456789012345;
    arc.persistence = 20.5;
    sample.settle();
    return sample;
}
