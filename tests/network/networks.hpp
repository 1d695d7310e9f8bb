// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <network/masks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>

/// Networks to prune, order and raise, drawn by hand or at random.
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

/// Trees of straight and bent arcs that pay no heed to where the others run; several basins, some pseudo nodes.
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

} // namespace test
