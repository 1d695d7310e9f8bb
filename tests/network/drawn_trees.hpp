// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/stream_network.hpp>

/// Trees of links, and how they are drawn without crossings.
namespace test {

using namespace thalweg;

/// By link: the link downstream; -1: none.
using Links = std::vector<std::int64_t>;

/// The links upstream of each.
inline std::vector<std::vector<std::size_t>> above_of(Links const& down) {
    std::vector<std::vector<std::size_t>> above(down.size());
    for (std::size_t i = 0; i < down.size(); ++i) {
        if (down[i] >= 0) {
            above[static_cast<std::size_t>(down[i])].push_back(i);
        }
    }
    return above;
}

/// The links in an order in which each follows the one downstream.
inline std::vector<std::size_t> downstream_first(Links const& down) {
    auto const above = above_of(down);
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < down.size(); ++i) {
        if (down[i] < 0) {
            order.push_back(i);
        }
    }
    for (std::size_t k = 0; k < order.size(); ++k) {
        order.insert(order.end(), above[order[k]].begin(), above[order[k]].end());
    }
    return order;
}

/// How many links are upstream of each, itself among them.
inline std::vector<double> sizes_of(Links const& down) {
    std::vector<double> size(down.size(), 1.0);
    auto const order = downstream_first(down);
    for (auto i = order.rbegin(); i != order.rend(); ++i) {
        if (down[*i] >= 0) {
            size[static_cast<std::size_t>(down[*i])] += size[*i];
        }
    }
    return size;
}

/// Draws a tree with one root: links lie in rows by their distance from the outlet, each over the middle of the sources
/// upstream, so that none cross, and runs down before it turns to the one below. Arc i is link i; node 0 is the outlet.
inline StreamNetwork drawn_tree(Links const& down, double step_m = 100.0) {
    auto const above = above_of(down);
    auto const order = downstream_first(down);
    std::vector<double> sources(down.size(), 0.0);
    for (auto i = order.rbegin(); i != order.rend(); ++i) {
        sources[*i] = above[*i].empty() ? 1.0 : sources[*i];
        if (down[*i] >= 0) {
            sources[static_cast<std::size_t>(down[*i])] += sources[*i];
        }
    }
    std::vector<double> west(down.size(), 0.0);
    std::vector<double> row(down.size(), 1.0);
    std::vector<Vec2> at(down.size());
    for (std::size_t const i : order) {
        at[i] = {500000.0 + step_m * (west[i] + 0.5 * sources[i]), 5000000.0 + step_m * row[i]};
        double next = west[i];
        for (std::size_t const up : above[i]) {
            west[up] = next;
            next += sources[up];
            row[up] = row[i] + 1.0;
        }
    }
    NetworkDraft net;
    net.add_node({at[order.front()].x, 5000000.0});
    for (Vec2 const p : at) {
        net.add_node(p);
    }
    for (std::size_t i = 0; i < down.size(); ++i) {
        NodeId const to = down[i] < 0 ? 0 : static_cast<NodeId>(down[i]) + 1;
        Arc arc;
        Vec2 const foot = to == 0 ? Vec2{at[order.front()].x, 5000000.0} : at[to - 1];
        arc.line = {at[i], {at[i].x, at[i].y - 0.5 * step_m}, foot};
        net.add_arc(i + 1, to, std::move(arc));
    }
    return net;
}

/// Peano's basin: each link is divided in the middle, where two more begin, as often as `times`. Source: Mandelbrot,
/// The fractal geometry of nature (1982); Marani et al., Water Resources Research 27 (1991).
inline Links peano_basin(int times) {
    Links down{-1};
    for (int t = 0; t < times; ++t) {
        std::size_t const links = down.size();
        Links divided(4 * links);
        for (std::size_t i = 0; i < links; ++i) { // 4 i is the lower half, 4 i + 1 the upper one
            divided[4 * i] = down[i] < 0 ? -1 : 4 * down[i] + 1;
            divided[4 * i + 1] = divided[4 * i + 2] = divided[4 * i + 3] = static_cast<std::int64_t>(4 * i);
        }
        down = std::move(divided);
    }
    return down;
}

/// A tree of which each stream of order w has exactly c^(k-1) side branches of order w - k. Source: Tokunaga (1978).
inline Links tokunaga_tree(int order, int c) {
    Links down;
    auto const add = [&](auto const& self, int w, std::int64_t below) -> void {
        std::int64_t link = static_cast<std::int64_t>(down.size());
        down.push_back(below);
        int branches = 1;
        for (int k = 1; k < w; ++k, branches *= c) {
            for (int b = 0; b < branches; ++b) {
                std::int64_t const next = static_cast<std::int64_t>(down.size());
                down.push_back(link);
                self(self, w - k, link);
                link = next;
            }
        }
        if (w > 1) {
            self(self, w - 1, link);
            self(self, w - 1, link);
        }
    };
    add(add, order, -1);
    return down;
}

/// A binary tree, each of as many sources equally likely (Shreve 1966; the way: Rémy 1985).
inline Links random_binary_tree(std::uint64_t seed, std::size_t sources) {
    Links down{-1};
    RandomStream words(seed, 17, 0);
    for (std::size_t s = 1; s < sources; ++s) {
        std::size_t const at = static_cast<std::size_t>(words.word() % down.size());
        auto const joint = static_cast<std::int64_t>(down.size());
        down.push_back(down[at]);
        down[at] = joint;
        down.push_back(joint);
    }
    return down;
}

} // namespace test
