// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <network/masks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>

/// Networks drawn by hand or at random, and what is often asked about them.
namespace test {

using namespace thalweg;

struct Reach {
    std::size_t from;
    std::size_t to;
    std::vector<Vec2> between = {}; ///< vertices between the nodes
    std::int64_t feature = 0;
    std::string type = {};
};

inline StreamNetwork network_of(std::vector<Vec2> const& nodes, std::vector<Reach> const& reaches) {
    NetworkDraft net;
    for (Vec2 const at : nodes) {
        net.add_node(at);
    }
    for (Reach const& r : reaches) {
        Arc arc;
        arc.line = {nodes[r.from]};
        arc.line.insert(arc.line.end(), r.between.begin(), r.between.end());
        arc.line.push_back(nodes[r.to]);
        arc.feature = r.feature;
        arc.type = r.type;
        net.add_arc(r.from, r.to, std::move(arc));
    }
    return net;
}

/// A skeleton of a random blob with a trunk to the south border, traced: burrs, loops cut open.
inline StreamNetwork random_skeleton(std::uint64_t seed, std::int64_t side) {
    Mask const blob = random_blob(seed, side, side, 2 + static_cast<int>(seed % 9), 1 + static_cast<int>(seed / 9 % 4));
    Mask skeleton = network::thin(blob);
    for (std::int64_t row = side / 2; row < side; ++row) {
        skeleton[Cell{side / 2, row}] = 1;
    }
    return network::trace(skeleton, {Vec2{static_cast<double>(seed % 7), 0.0}});
}

/// Trees of straight and bent arcs that may cross; several basins, some pseudo nodes.
inline StreamNetwork random_forest(std::uint64_t seed, std::size_t nodes, std::size_t basins) {
    RandomStream words(seed, 3, 0);
    auto const place = [&] { return Vec2{1000.0 * words.real(), 1000.0 * words.real()}; };
    std::vector<Vec2> at;
    std::vector<Reach> reaches;
    for (std::size_t n = 0; n < nodes + 2 * basins; ++n) {
        at.push_back(place());
        // The first nodes are the outlets, each gets one arc at least.
        if (n >= basins) {
            Reach r{n, n < 2 * basins ? n - basins : static_cast<std::size_t>(words.word() % n)};
            for (std::uint64_t k = words.word() % 4; k > 0; --k) {
                r.between.push_back(place());
            }
            r.feature = static_cast<std::int64_t>(n);
            r.type = std::string(1, n % 2 == 0 ? 'A' : 'C');
            reaches.push_back(r);
        }
    }
    return network_of(at, reaches);
}

/// A skeleton or a forest, for rapidcheck.
inline StreamNetwork any_network() {
    auto const seed = *rc::gen::arbitrary<std::uint64_t>();
    if (*rc::gen::arbitrary<bool>()) {
        return random_skeleton(seed, *rc::gen::inRange<std::int64_t>(10, 40));
    }
    return random_forest(seed, *rc::gen::inRange<std::size_t>(0, 30), *rc::gen::inRange<std::size_t>(1, 4));
}

/// One chain of arcs a metre long, the outlet at node 0.
inline StreamNetwork chain(std::size_t arcs) {
    NetworkDraft net;
    net.add_node({0.0, 0.0});
    for (std::size_t n = 1; n <= arcs; ++n) {
        net.add_node({static_cast<double>(n), 0.0});
        net.add_arc(n, n - 1);
    }
    return net;
}

/// Heights of nodes; along arcs linear by length.
inline ElevatedNetwork elevated(StreamNetwork plan, std::vector<double> node_z) {
    ElevatedNetwork out{std::move(plan), std::move(node_z), {}};
    for (std::size_t a = 0; a < out.planform.arc_count(); ++a) {
        auto const& line = out.planform.arc(a).line;
        double const high = out.node_z[out.planform.from(a)];
        double const low = out.node_z[out.planform.to(a)];
        double along = 0.0;
        auto& z = out.arc_z.emplace_back(1, high);
        for (std::size_t i = 1; i < line.size(); ++i) {
            along += distance(line[i - 1], line[i]);
            z.push_back(i + 1 == line.size() ? low : high + (low - high) * along / out.planform.length_m(a));
        }
    }
    return out;
}

/// Rivers that meet in one point, evenly around it, and leave it to the south, or end there.
inline ElevatedNetwork star(int rivers, bool outlet_in_the_middle, double reach_m = 100.0, double leaving_m = 100.0) {
    Vec2 const middle{4000000.1, 500000.7};
    std::vector<Vec2> nodes{middle};
    std::vector<double> z{10.0};
    std::vector<Reach> reaches;
    for (int i = 1; i <= rivers; ++i) {
        double const angle = 2.0 * std::numbers::pi * i / (rivers + 1) - std::numbers::pi / 2.0;
        nodes.push_back({middle.x + reach_m * std::cos(angle), middle.y + reach_m * std::sin(angle)});
        z.push_back(10.0 + i);
        reaches.push_back({nodes.size() - 1, 0});
    }
    if (!outlet_in_the_middle) {
        nodes.push_back({middle.x, middle.y - leaving_m});
        z.push_back(0.0);
        reaches.push_back({0, nodes.size() - 1});
    }
    return elevated(network_of(nodes, reaches), z);
}

/// Law: an arc has one height a vertex, those of its nodes at its ends, and does not rise downstream.
inline void require_heights(ElevatedNetwork const& rivers) {
    RC_ASSERT(rivers.arc_z.size() == rivers.planform.arc_count());
    for (std::size_t a = 0; a < rivers.arc_z.size(); ++a) {
        std::vector<double> const& z = rivers.arc_z[a];
        RC_ASSERT(z.size() == rivers.planform.arc(a).line.size());
        RC_ASSERT(z.front() == rivers.node_z[rivers.planform.from(a)]);
        RC_ASSERT(z.back() == rivers.node_z[rivers.planform.to(a)]);
        RC_ASSERT(std::is_sorted(z.rbegin(), z.rend()));
    }
}

/// Whether two networks agree bit by bit, with their numbers.
inline bool same_network(StreamNetwork const& a, StreamNetwork const& b) {
    bool same = a.from() == b.from() && a.to() == b.to() && a.node_count() == b.node_count();
    for (NodeId n = 0; same && n < a.node_count(); ++n) {
        same = a.node(n).at == b.node(n).at;
    }
    for (std::size_t k = 0; same && k < a.arc_count(); ++k) {
        Arc const& p = a.arc(k);
        Arc const& q = b.arc(k);
        same = p.line == q.line && p.persistence == q.persistence && p.feature == q.feature && p.type == q.type;
    }
    return same;
}

/// Where arcs meet away from their common nodes.
inline std::vector<geometry::Meeting> meetings_of(StreamNetwork const& net) {
    std::vector<std::vector<Vec2>> lines;
    std::vector<geometry::EndNodes> nodes;
    for (std::size_t a = 0; a < net.arc_count(); ++a) {
        lines.push_back(net.arc(a).line);
        nodes.push_back({net.from(a), net.to(a)});
    }
    return geometry::meetings(lines, nodes);
}

} // namespace test
