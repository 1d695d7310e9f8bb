// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/stream_network.hpp>

/// Scheidegger's random rivers (1967): every point of a lattice drains to the one south or south-east of it, so that no
/// two reaches cross. Row 0 holds the outlets; points are spacing_m apart, the first half of it from the axes; heights
/// are the rows' numbers. Its arcs run from sources and confluences; about half as many as points.
inline thalweg::ElevatedNetwork random_rivers(std::uint64_t seed, std::int64_t cols, std::int64_t rows,
                                              double spacing_m = 1.0) {
    using namespace thalweg;
    auto const id = [&](std::int64_t col, std::int64_t row) { return static_cast<std::size_t>(row * cols + col); };
    auto const below = [&](std::size_t p) {
        auto const col = static_cast<std::int64_t>(p) % cols;
        auto const east = static_cast<std::int64_t>(random_word(seed, p) % 2);
        return id(std::min(col + east, cols - 1), static_cast<std::int64_t>(p) / cols - 1);
    };
    auto const row_of = [&](std::size_t p) { return static_cast<double>(static_cast<std::int64_t>(p) / cols); };
    auto const place = [&](std::size_t p) {
        return Vec2{(static_cast<double>(static_cast<std::int64_t>(p) % cols) + 0.5) * spacing_m,
                    (row_of(p) + 0.5) * spacing_m};
    };
    std::size_t const points = id(0, rows);
    std::size_t const first_row = id(0, 1);
    std::vector<int> arriving(points, 0);
    for (std::size_t p = first_row; p < points; ++p) {
        ++arriving[below(p)];
    }
    ElevatedNetwork rivers;
    NetworkDraft plan;
    std::vector<NodeId> node(points);
    auto const is_node = [&](std::size_t p) { return p < first_row ? arriving[p] > 0 : arriving[p] != 1; };
    for (std::size_t p = 0; p < points; ++p) {
        if (is_node(p)) {
            node[p] = plan.add_node(place(p));
            rivers.node_z.push_back(row_of(p));
        }
    }
    for (std::size_t p = first_row; p < points; ++p) {
        if (is_node(p)) {
            Arc arc;
            std::size_t at = p;
            arc.line.push_back(place(at));
            rivers.arc_z.push_back({row_of(at)});
            do {
                at = below(at);
                arc.line.push_back(place(at));
                rivers.arc_z.back().push_back(row_of(at));
            } while (!is_node(at));
            plan.add_arc(node[p], node[at], std::move(arc));
        }
    }
    rivers.planform = std::move(plan);
    return rivers;
}

/// The orders that a network's file holds.
inline thalweg::NetworkOrders orders_of(thalweg::StreamNetwork const& network) {
    using namespace thalweg;
    NetworkOrders orders;
    orders.strahler.assign(network.arc_count(), 1);
    orders.shreve.assign(network.arc_count(), 1);
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        orders.arc_basin.push_back(network.basin(network.to(a)));
    }
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) {
        if (network.out(*n) == no_arc || network.in(*n).empty()) {
            continue;
        }
        std::vector<int> arriving;
        std::int64_t sources = 0;
        for (auto const a : network.in(*n)) {
            arriving.push_back(orders.strahler[static_cast<std::size_t>(a)]);
            sources += orders.shreve[static_cast<std::size_t>(a)];
        }
        int const highest = *std::max_element(arriving.begin(), arriving.end());
        auto const leaving = network.out(*n);
        orders.strahler[leaving] = highest + (std::count(arriving.begin(), arriving.end(), highest) > 1 ? 1 : 0);
        orders.shreve[leaving] = sources;
    }
    return orders;
}
