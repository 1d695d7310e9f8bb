// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/vectorise.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <network/masks.hpp>
#include <network/plain_thinning.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

namespace vectorise_test {

namespace {

using namespace thalweg;
using network::thin;
using network::trace;

/// Steps to the outlet by sweeping over all cells until nothing improves (Bellman and Ford): orthogonal, diagonal.
struct Way {
    std::int64_t orthogonal = 0;
    std::int64_t diagonal = 0;
    std::int64_t parent = -1;
    double cells() const { return static_cast<double>(orthogonal) + static_cast<double>(diagonal) * std::sqrt(2.0); }
};

std::map<std::int64_t, Way> plain_tree(Mask const& mask, Vec2 mouth) {
    Grid const& grid = mask.grid();
    auto const set = [&](Cell c) { return grid.contains(c) && mask[c] != 0; };
    auto const label = test::labels_of(mask, 1, 8);
    std::map<std::int64_t, std::int64_t> outlet; // by component
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        if (mask[i] != 0) {
            auto const at = outlet.try_emplace(label[i], i).first;
            bool const nearer =
                distance(grid.centre(grid.at(i)), mouth) < distance(grid.centre(grid.at(at->second)), mouth);
            at->second = nearer ? i : at->second;
        }
    }
    std::map<std::int64_t, Way> way;
    for (auto const& [component, cell] : outlet) {
        way[cell].parent = cell;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (std::int64_t i = 0; i < mask.cells(); ++i) {
            Cell const c = grid.at(i);
            cells_around(grid, c, 1, [&](Cell n) {
                bool const diagonal = n.col != c.col && n.row != c.row;
                auto const from = way.find(grid.index(n));
                if (mask[i] == 0 || n == c || from == way.end() ||
                    (diagonal && (set({c.col, n.row}) || set({n.col, c.row})))) {
                    return;
                }
                Way const there{from->second.orthogonal + (diagonal ? 0 : 1),
                                from->second.diagonal + (diagonal ? 1 : 0), from->first};
                if (!way.contains(i) || there.cells() < way[i].cells() ||
                    (there.cells() == way[i].cells() && there.parent < way[i].parent)) {
                    way[i] = there;
                    changed = true;
                }
            });
        }
    }
    return way;
}

Mask any_skeleton() {
    auto const seed = *rc::gen::arbitrary<std::uint64_t>();
    auto const width = *rc::gen::inRange<std::int64_t>(2, 40);
    auto const height = *rc::gen::inRange<std::int64_t>(2, 30);
    switch (*rc::gen::inRange(0, 3)) {
    case 0: return test::random_mask(seed, width, height, *rc::gen::element(0.3, 0.5, 0.8));
    case 1: return thin(test::random_mask(seed, width, height, *rc::gen::element(0.3, 0.5, 0.8)));
    default: return thin(test::random_blob(seed, width, height, *rc::gen::inRange(1, 12), *rc::gen::inRange(1, 5)));
    }
}

/// A mask of either kind, its width around the multiples of 64 and far from them.
Mask any_mask() {
    auto const seed = *rc::gen::arbitrary<std::uint64_t>();
    auto const width = *rc::gen::element<std::int64_t>(1, 2, 3, 17, 63, 64, 65, 127, 128, 130, 200);
    auto const height = *rc::gen::inRange<std::int64_t>(1, 40);
    if (*rc::gen::arbitrary<bool>()) {
        return test::random_mask(seed, width, height, *rc::gen::element(0.2, 0.5, 0.7, 0.9, 0.98));
    }
    return test::random_blob(seed, width, height, *rc::gen::inRange(1, 12), *rc::gen::inRange(1, 8));
}

} // namespace

TEST(Trace, NothingToTrace) {
    for (Mask const& mask : {Mask(), Mask(test::frame(5, 5)), test::mask_of({"#....", "..#..", "....#"})}) {
        EXPECT_TRUE(test::refused("network.trace", [&] { trace(mask, {Vec2{}}); }));
    }
    EXPECT_THROW(trace(test::mask_of({"##"}), {Vec2{NAN, 0.0}}), BadParameter);
}

TEST(Trace, IsTheShortestPathTree) {
    ASSERT_TRUE(rc::check("Dijkstra = Bellman-Ford, every cell reached, laws of a network", [] {
        Mask const mask = any_skeleton();
        Vec2 const mouth{static_cast<double>(*rc::gen::inRange<int>(-5, 45)),
                         static_cast<double>(*rc::gen::inRange<int>(-5, 35)) + 0.5};
        auto const tree = plain_tree(mask, mouth);
        RC_ASSERT(std::ssize(tree) == std::ranges::count(mask.values(), std::uint8_t{1})); // m-adjacency loses no cell
        std::map<std::int64_t, std::int64_t> children;
        std::map<std::int64_t, std::int64_t> parents;
        for (auto const& [i, way] : tree) {
            if (way.parent != i) {
                ++children[way.parent];
                parents[i] = way.parent;
            }
        }
        if (parents.empty()) {
            RC_ASSERT_THROWS_AS(trace(mask, {mouth}), BadInput);
            return;
        }
        StreamNetwork const net = trace(mask, {mouth});
        std::map<std::int64_t, std::int64_t> traced;
        std::int64_t last_start = -1;
        for (ArcId arc = 0; arc < net.arc_count(); ++arc) {
            std::vector<Vec2> const& line = net.arc(arc).line;
            RC_ASSERT(line.front() == net.node(net.from(arc)).at);
            RC_ASSERT(line.back() == net.node(net.to(arc)).at);
            std::vector<std::int64_t> cells;
            for (Vec2 const p : line) {
                cells.push_back(mask.grid().index(mask.grid().cell_of(p)));
                RC_ASSERT(p == mask.grid().centre(mask.grid().at(cells.back())));
            }
            RC_ASSERT(cells.front() > last_start); // numbered by source cell
            last_start = cells.front();
            RC_ASSERT(children[cells.front()] != 1);
            for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
                RC_ASSERT(traced.emplace(cells[i], cells[i + 1]).second);
                RC_ASSERT((i == 0 || children[cells[i]] == 1));
            }
        }
        RC_ASSERT(traced == parents); // every cell that drains is drawn, once
        auto const outlets = std::ranges::count_if(
            tree, [&](auto const& at) { return at.second.parent == at.first && children[at.first] > 0; });
        RC_ASSERT(std::ssize(net.outlets()) == outlets);
        RC_ASSERT(net.node_count() == net.arc_count() + net.outlets().size());
        RC_ASSERT(net.upstream_order().size() == net.node_count());
    }));
}

TEST(Thin, EmptyAndFullAndSingle) {
    EXPECT_EQ(thin(Mask()).cells(), 0);
    EXPECT_TRUE(test::same_bits(thin(Mask(test::frame(70, 3))), Mask(test::frame(70, 3))));
    EXPECT_TRUE(test::same_bits(thin(Mask(test::frame(1, 1), 1)), Mask(test::frame(1, 1), 1)));
    EXPECT_EQ(test::components(thin(Mask(test::frame(130, 70), 1)), 1, 8), 1);
}

TEST(Thin, EqualsGuoHallCellByCell) {
    ASSERT_TRUE(rc::check("64 cells a word = cell by cell", [] {
        Mask mask = any_mask();
        Mask const skeleton = test::plain_thin(mask);
        for (std::int64_t i = 0; i < mask.cells(); ++i) { // any value but 0 is inside
            mask[i] = mask[i] != 0 ? static_cast<std::uint8_t>(1 + 127 * (i % 3)) : 0;
        }
        RC_ASSERT(test::same_bits(thin(mask), skeleton));
    }));
}

TEST(Thin, Stops) {
    EXPECT_THROW(thin(Mask(test::frame(8, 8), 1), test::stopped_run()), Cancelled);
}

} // namespace vectorise_test
