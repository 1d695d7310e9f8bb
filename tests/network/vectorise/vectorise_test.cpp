// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/vectorise.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

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
    auto const near = [&](std::int64_t i) {
        std::vector<std::pair<std::int64_t, bool>> out;
        Cell const c = grid.at(i);
        for (std::int64_t dr = -1; dr <= 1; ++dr) {
            for (std::int64_t dc = -1; dc <= 1; ++dc) {
                Cell const n{c.col + dc, c.row + dr};
                bool const diagonal = dr != 0 && dc != 0;
                if ((dr != 0 || dc != 0) && set(n) && !(diagonal && (set({c.col, n.row}) || set({n.col, c.row})))) {
                    out.emplace_back(grid.index(n), diagonal);
                }
            }
        }
        return out;
    };
    // The component of each cell: the least index that 8-neighbours reach.
    std::map<std::int64_t, std::int64_t> least;
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        if (mask[i] != 0) {
            least[i] = i;
        }
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (auto& [i, label] : least) {
            Cell const c = grid.at(i);
            for (std::int64_t dr = -1; dr <= 1; ++dr) {
                for (std::int64_t dc = -1; dc <= 1; ++dc) {
                    Cell const n{c.col + dc, c.row + dr};
                    if (set(n) && least[grid.index(n)] < label) {
                        label = least[grid.index(n)];
                        changed = true;
                    }
                }
            }
        }
    }
    std::map<std::int64_t, std::int64_t> outlet;
    for (auto const& [i, label] : least) {
        auto const [at, is_new] = outlet.try_emplace(label, i);
        if (!is_new && distance(grid.centre(grid.at(i)), mouth) < distance(grid.centre(grid.at(at->second)), mouth)) {
            at->second = i;
        }
    }
    std::map<std::int64_t, Way> way;
    for (auto const& [label, cell] : outlet) {
        way[cell].parent = cell;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (auto const& [i, label] : least) {
            for (auto const& [n, diagonal] : near(i)) {
                if (!way.contains(n)) {
                    continue;
                }
                Way const there{way[n].orthogonal + (diagonal ? 0 : 1), way[n].diagonal + (diagonal ? 1 : 0), n};
                if (!way.contains(i) || there.cells() < way[i].cells() ||
                    (there.cells() == way[i].cells() && n < way[i].parent)) {
                    way[i] = there;
                    changed = true;
                }
            }
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

bool same(Mask const& a, Mask const& b) {
    return a.grid() == b.grid() && std::equal(a.values().begin(), a.values().end(), b.values().begin());
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
    EXPECT_THROW(trace(Mask(), {Vec2{}}), BadInput);
    EXPECT_THROW(trace(Mask(test::frame(5, 5)), {Vec2{}}), BadInput);
    EXPECT_THROW(trace(test::mask_of({"#....", "..#..", "....#"}), {Vec2{}}), BadInput);
    EXPECT_THROW(trace(test::mask_of({"##"}), {Vec2{NAN, 0.0}}), BadParameter);
}

TEST(Trace, TheMouthChoosesTheOutletAndTiesGoToTheLowerCell) {
    Mask const line = test::mask_of({"#####"});
    EXPECT_EQ(trace(line, {Vec2{4.5, 0.5}}).node(1).at, (Vec2{4.5, 0.5}));
    // Cells 1 and 2 are equally near to x = 2: the outlet is cell 1, in the middle of the river.
    StreamNetwork const net = trace(line, {Vec2{2.0, 0.5}});
    ASSERT_EQ(net.outlets().size(), 1U);
    EXPECT_EQ(net.node(net.outlets()[0]).at, (Vec2{1.5, 0.5}));
    EXPECT_EQ(net.in(net.outlets()[0]).size(), 2U);
}

TEST(Trace, LoopsAreCutWhereTheWaysMeet) {
    StreamNetwork const net = trace(test::mask_of({".#.", "#.#", ".#."}), {Vec2{1.5, 3.0}});
    // The southern cell is as far by the west as by the east: it drains to the western one, of lower net.
    ASSERT_EQ(net.arc_count(), 2U);
    EXPECT_EQ(net.arc(0).line, (std::vector<Vec2>{{2.5, 1.5}, {1.5, 2.5}}));
    EXPECT_EQ(net.arc(1).line, (std::vector<Vec2>{{1.5, 0.5}, {0.5, 1.5}, {1.5, 2.5}}));
}

TEST(Trace, IsTheShortestPathTree) {
    ASSERT_TRUE(rc::check("Dijkstra = Bellman-Ford, every cell reached, laws of a network", [] {
        Mask const mask = any_skeleton();
        Vec2 const mouth{static_cast<double>(*rc::gen::inRange<int>(-5, 45)),
                         static_cast<double>(*rc::gen::inRange<int>(-5, 35)) + 0.5};
        auto const tree = plain_tree(mask, mouth);
        std::int64_t set = 0;
        for (auto const v : mask.values()) {
            set += v;
        }
        RC_ASSERT(static_cast<std::int64_t>(tree.size()) == set); // m-adjacency loses no cell of a component
        std::map<std::int64_t, std::int64_t> children;
        for (auto const& [i, way] : tree) {
            children[i] += 0;
            if (way.parent != i) {
                ++children[way.parent];
            }
        }
        if (std::all_of(children.begin(), children.end(), [](auto const& c) { return c.second == 0; })) {
            RC_ASSERT_THROWS_AS(trace(mask, {mouth}), BadInput);
            return;
        }
        StreamNetwork const net = trace(mask, {mouth});
        std::set<std::int64_t> starts;
        std::int64_t last_start = -1;
        std::int64_t steps = 0;
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
            for (std::size_t i = 0; i + 1 < cells.size(); ++i, ++steps) {
                RC_ASSERT(tree.at(cells[i]).parent == cells[i + 1]);
                RC_ASSERT((i == 0 || children[cells[i]] == 1));
            }
        }
        std::int64_t draining = 0;
        std::int64_t outlets = 0;
        for (auto const& [i, way] : tree) {
            draining += way.parent != i ? 1 : 0;
            outlets += way.parent == i && children[i] > 0 ? 1 : 0;
        }
        RC_ASSERT(steps == draining); // every cell that drains is drawn, once
        RC_ASSERT(static_cast<std::int64_t>(net.outlets().size()) == outlets);
        RC_ASSERT(net.node_count() == net.arc_count() + net.outlets().size());
        RC_ASSERT(net.upstream_order().size() == net.node_count());
    }));
}

TEST(Trace, InMetres) {
    Mask mask(Grid{3, 1, 30.0, 500000.0, 4000000.0, "EPSG:32611"}, 1);
    StreamNetwork const net = trace(mask, {Vec2{500000.0, 4000000.0}});
    EXPECT_EQ(net.arc(0).line,
              (std::vector<Vec2>{{500075.0, 3999985.0}, {500045.0, 3999985.0}, {500015.0, 3999985.0}}));
}

TEST(Thin, EmptyAndFullAndSingle) {
    EXPECT_EQ(thin(Mask()).cells(), 0);
    EXPECT_TRUE(same(thin(Mask(test::frame(70, 3))), Mask(test::frame(70, 3))));
    EXPECT_TRUE(same(thin(Mask(test::frame(1, 1), 1)), Mask(test::frame(1, 1), 1)));
    EXPECT_EQ(test::components(thin(Mask(test::frame(130, 70), 1)), 1, 8), 1);
}

TEST(Thin, AnyValueButZeroIsInside) {
    Mask mask(test::frame(70, 9), 255);
    mask[Cell{3, 3}] = 128;
    EXPECT_TRUE(same(thin(mask), thin(Mask(test::frame(70, 9), 1))));
}

TEST(Thin, EqualsGuoHallCellByCell) {
    ASSERT_TRUE(rc::check("64 cells a word = cell by cell", [] {
        Mask const mask = any_mask();
        Mask const skeleton = thin(mask);
        RC_ASSERT(same(skeleton, test::plain_thin(mask)));
        RC_ASSERT(same(skeleton, test::table_thin(mask)));
    }));
}

TEST(Thin, Stops) {
    std::stop_source source;
    source.request_stop();
    thalweg::Run run;
    run.stop = source.get_token();
    EXPECT_THROW(thin(Mask(test::frame(8, 8), 1), run), Cancelled);
}

} // namespace vectorise_test
