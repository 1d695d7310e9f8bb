// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <rapidcheck.h>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/stream_network.hpp>

/// Rivers as a file gives them.
namespace test {

using namespace thalweg;

/// Lines with these vertices, numbered from 1.
inline RiverLines lines_of(std::vector<std::vector<Vec3>> const& drawn, std::string const& name = "rivers.gpkg") {
    RiverLines lines;
    lines.name = name;
    for (auto const& vertices : drawn) {
        lines.lines.push_back({static_cast<std::int64_t>(lines.lines.size()) + 1, vertices, "", 0});
    }
    return lines;
}

/// The same without heights.
inline RiverLines flats(std::vector<std::vector<Vec2>> const& plans) {
    std::vector<std::vector<Vec3>> drawn;
    for (auto const& plan : plans) {
        auto& vertices = drawn.emplace_back();
        for (Vec2 const p : plan) {
            vertices.push_back({p.x, p.y, std::numeric_limits<double>::quiet_NaN()});
        }
    }
    return lines_of(drawn);
}

/// Edges of a lattice of 100 m whose vertices are moved by up to 20 m, so that edges meet in common vertices only: a
/// tree, and some edges that close loops. Each is drawn away from vertex 0.
struct Lattice {
    std::vector<Vec2> at;
    std::vector<std::pair<std::size_t, std::size_t>> edges; ///< from vertex, to vertex; of a tree by the latter
};

/// head: vertex 0 has one edge.
enum class First { any, head };

inline Lattice random_lattice(int size, int loops, First first = First::any) {
    Lattice lattice;
    std::map<std::pair<int, int>, std::size_t> taken;
    std::vector<std::pair<int, int>> cell;
    auto const add = [&](std::pair<int, int> c) {
        taken[c] = cell.size();
        cell.push_back(c);
        auto const moved = [] { return *rc::gen::inRange(-20000, 20001) * 1e-3; };
        lattice.at.push_back(rounded(Vec2{c.first * 100.0 + moved(), c.second * 100.0 + moved()}));
    };
    add({0, 0});
    constexpr std::pair<int, int> beside[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int tries = 0; tries < 3 * size && static_cast<int>(cell.size()) < size; ++tries) {
        auto const from = static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(cell.size())));
        auto const [dx, dy] = beside[*rc::gen::inRange(0, 4)];
        std::pair<int, int> const to{cell[from].first + dx, cell[from].second + dy};
        if (first == First::head && from == 0 && cell.size() > 1) {
            continue;
        }
        if (!taken.contains(to)) {
            add(to);
            lattice.edges.emplace_back(from, cell.size() - 1);
        } else if (loops > 0) {
            std::pair const edge = std::minmax(from, taken.at(to));
            if (std::ranges::find(lattice.edges, std::pair(edge.first, edge.second)) == lattice.edges.end()) {
                lattice.edges.emplace_back(edge.first, edge.second);
                --loops;
            }
        }
    }
    return lattice;
}

using Step = std::pair<std::pair<double, double>, std::pair<double, double>>;

inline Step step(Vec2 a, Vec2 b) {
    return {{a.x, a.y}, {b.x, b.y}};
}

/// Every segment of a network, downstream.
inline std::set<Step> steps_of(StreamNetwork const& net) {
    std::set<Step> steps;
    for (Arc const& arc : net.arcs()) {
        for (std::size_t i = 1; i < arc.line.size(); ++i) {
            steps.insert(step(arc.line[i - 1], arc.line[i]));
        }
    }
    return steps;
}

/// The edges of a lattice, towards vertex 0.
inline std::set<Step> steps_of(Lattice const& lattice) {
    std::set<Step> steps;
    for (auto const& [from, to] : lattice.edges) {
        steps.insert(step(lattice.at[to], lattice.at[from]));
    }
    return steps;
}

} // namespace test
