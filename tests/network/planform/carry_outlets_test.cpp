// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/carry_outlets.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>

namespace carry_outlets_test {

namespace {

using namespace thalweg;
using network::carry_outlets;

/// Positions are multiples of 1/128, so that products of differences are exact.
struct Piece {
    Vec2 a;
    Vec2 b;
};

int side(Vec2 a, Vec2 b, Vec2 p) {
    double const c = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    return c > 0.0 ? 1 : c < 0.0 ? -1 : 0;
}

bool on(Piece s, Vec2 p) {
    return side(s.a, s.b, p) == 0 && p.x >= std::min(s.a.x, s.b.x) && p.x <= std::max(s.a.x, s.b.x) &&
           p.y >= std::min(s.a.y, s.b.y) && p.y <= std::max(s.a.y, s.b.y);
}

bool meet(Piece s, Piece t) {
    return (side(s.a, s.b, t.a) * side(s.a, s.b, t.b) < 0 && side(t.a, t.b, s.a) * side(t.a, t.b, s.b) < 0) ||
           on(s, t.a) || on(s, t.b) || on(t, s.a) || on(t, s.b);
}

/// They meet, and not only in a common end.
bool conflict(Piece s, Piece t) {
    for (Vec2 const p : {s.a, s.b}) {
        if (p == t.a || p == t.b) {
            Vec2 const s_end = p == s.a ? s.b : s.a;
            Vec2 const t_end = p == t.a ? t.b : t.a;
            return on(s, t_end) || on(t, s_end);
        }
    }
    return meet(s, t);
}

std::vector<Piece> pieces_of(std::vector<Vec2> const& line) {
    std::vector<Piece> out;
    for (std::size_t i = 1; i < line.size(); ++i) {
        out.push_back({line[i - 1], line[i]});
    }
    return out;
}

/// Small rivers inside a grid of 32 cells, at multiples of 1/128; their arcs may even cross.
StreamNetwork scattered_rivers(std::uint64_t seed, std::size_t basins) {
    RandomStream words(seed, 4, 0);
    auto const within = [&](double centre, double reach) {
        double const x = centre + reach * (2.0 * words.real() - 1.0);
        return std::floor(std::clamp(x, 0.0, 32.0) * 128.0) / 128.0;
    };
    std::vector<Vec2> at;
    std::vector<test::Reach> reaches;
    for (std::size_t b = 0; b < basins; ++b) {
        std::size_t const first = at.size();
        at.push_back({within(16.0, 14.0), within(16.0, 14.0)});
        std::size_t const arcs = 1 + words.word() % 8;
        for (std::size_t k = 0; k < arcs; ++k) {
            std::size_t const to = first + words.word() % (at.size() - first);
            Vec2 const from{within(at[to].x, 3.0), within(at[to].y, 3.0)};
            Vec2 const middle{within(at[to].x, 2.0), within(at[to].y, 2.0)};
            if (from == at[to] || middle == at[to] || middle == from) {
                continue;
            }
            at.push_back(from);
            reaches.push_back({at.size() - 1, to, {middle}, static_cast<std::int64_t>(10 * at.size())});
        }
    }
    return test::network_of(at, reaches);
}

/// Cell by cell what the rivers occupy, brute force.
struct PlainGround {
    Grid grid;
    std::set<std::int64_t> river;
    std::set<std::pair<std::int64_t, std::int64_t>> diagonal; ///< steps between cells, the lower index first
    std::vector<Piece> pieces;

    void add(std::vector<Vec2> const& line) {
        std::vector<Cell> const cells = cells_along(line, grid);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            river.insert(grid.index(cells[i]));
            if (i > 0 && cells[i].col != cells[i - 1].col && cells[i].row != cells[i - 1].row) {
                diagonal.insert(std::minmax(grid.index(cells[i - 1]), grid.index(cells[i])));
            }
        }
        for (Piece const p : pieces_of(line)) {
            pieces.push_back(p);
        }
    }
    bool open(Vec2 p, Cell from, Cell to) const {
        if (!grid.contains(to) || river.contains(grid.index(to))) {
            return false;
        }
        Cell const east{to.col, from.row};
        Cell const south{from.col, to.row};
        if (from.col != to.col && from.row != to.row &&
            diagonal.contains(std::minmax(grid.index(east), grid.index(south)))) {
            return false;
        }
        Piece const step{p, grid.centre(to)};
        return std::none_of(pieces.begin(), pieces.end(), [&](Piece const& q) { return conflict(step, q); });
    }
    double cost(Cell c) const {
        std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
        for (std::int64_t const i : river) {
            Cell const r = grid.at(i);
            nearest = std::min(nearest, std::abs(r.col - c.col) + std::abs(r.row - c.row));
        }
        double const d = static_cast<double>(nearest) + 0.5;
        return 1.0 + 10.0 / (d * d);
    }
    /// Cost of the cheapest way to the border, by relaxing every step until nothing improves; infinite without a way.
    double cheapest(Vec2 outlet) const {
        Cell const start = cells_along({outlet}, grid)[0];
        std::vector<double> cost_to(static_cast<std::size_t>(grid.cells()), std::numeric_limits<double>::infinity());
        std::vector<double> enter;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            enter.push_back(cost(grid.at(i)));
        }
        cost_to[static_cast<std::size_t>(grid.index(start))] = 0.0;
        std::vector<Cell> open_cells{start};
        while (!open_cells.empty()) {
            Cell const c = open_cells.back();
            open_cells.erase(open_cells.end() - 1);
            for (std::int64_t k = 0; k < 9; ++k) {
                Cell const n{c.col + k % 3 - 1, c.row + k / 3 - 1};
                if (!grid.contains(n)) {
                    continue;
                }
                double const there =
                    cost_to[static_cast<std::size_t>(grid.index(c))] +
                    enter[static_cast<std::size_t>(grid.index(n))] * (k % 2 == 0 ? std::sqrt(2.0) : 1.0);
                if (there < cost_to[static_cast<std::size_t>(grid.index(n))] - 1e-12 &&
                    open(c == start ? outlet : grid.centre(c), c, n)) {
                    cost_to[static_cast<std::size_t>(grid.index(n))] = there;
                    open_cells.insert(open_cells.begin(), n);
                }
            }
        }
        double best = std::numeric_limits<double>::infinity();
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (grid.on_border(grid.at(i))) {
                best = std::min(best, cost_to[static_cast<std::size_t>(i)]);
            }
        }
        return best;
    }
    double cost_of(std::vector<Vec2> const& way) const {
        double sum = 0.0;
        std::vector<Cell> const cells = cells_along(way, grid);
        for (std::size_t i = 1; i < cells.size(); ++i) {
            bool const oblique = cells[i].col != cells[i - 1].col && cells[i].row != cells[i - 1].row;
            sum += cost(cells[i]) * (oblique ? std::sqrt(2.0) : 1.0);
        }
        return sum;
    }
};

/// What was added at each carried outlet, the old outlet first; checks that all that was drawn is still there.
std::vector<std::vector<Vec2>> ways_of(StreamNetwork const& before, network::CarriedNetwork const& carried) {
    std::vector<std::vector<Vec2>> ways;
    RC_ASSERT(carried.network.arc_count() >= before.arc_count());
    for (std::size_t a = 0; a < carried.network.arc_count(); ++a) {
        std::vector<Vec2> const& line = carried.network.arc(a).line;
        RC_ASSERT(line.front() == carried.network.node(carried.network.from(a)).at);
        RC_ASSERT(line.back() == carried.network.node(carried.network.to(a)).at);
        if (a >= before.arc_count()) {
            RC_ASSERT(before.in(carried.network.from(a)).size() > 1U); // a confluence that was an outlet
            ways.push_back(line);
            continue;
        }
        std::vector<Vec2> const& drawn = before.arc(a).line;
        RC_ASSERT((carried.network.from(a) == before.from(a) && carried.network.to(a) == before.to(a)));
        RC_ASSERT(before.arc(a).feature == carried.network.arc(a).feature);
        RC_ASSERT(line.size() >= drawn.size());
        RC_ASSERT(std::equal(drawn.begin(), drawn.end(), line.begin()));
        if (line.size() > drawn.size()) {
            RC_ASSERT(before.in(before.to(a)).size() == 1U);
            ways.emplace_back(line.begin() + static_cast<std::ptrdiff_t>(drawn.size()) - 1, line.end());
        }
    }
    return ways;
}

/// Ways beside rivers cost no more than elsewhere, and none is joined.
network::CarryParams const alone{.join = false, .beside_cells = 0.0};

} // namespace

TEST(CarryOutlets, NothingToCarry) {
    Grid const grid = test::frame(5, 5);
    EXPECT_EQ(carry_outlets({}, grid).network.arc_count(), 0U);
    auto const at_the_border = carry_outlets(test::network_of({{2.5, 0.5}, {2.5, 3.5}}, {{1, 0}}), grid);
    EXPECT_TRUE(at_the_border.notes.empty());
    EXPECT_EQ(at_the_border.network.node(0).at, (Vec2{2.5, 0.5}));
    EXPECT_THROW(carry_outlets(test::network_of({{2.5, 0.5}, {2.5, 9.5}}, {{1, 0}}), grid), BadInput);
    EXPECT_THROW(carry_outlets(test::network_of({{2, 2}, {3, 3}}, {{1, 0}, {0, 1}}), grid), BadInput);
    EXPECT_THROW(carry_outlets({}, grid, {.join_cells = -1.0}), BadParameter);
    EXPECT_THROW(carry_outlets({}, grid, {.beside_cells = std::nan("")}), BadParameter);
}

TEST(CarryOutlets, OneArcIsDrawnOn) {
    Grid const grid = test::frame(15, 7);
    auto const carried = carry_outlets(test::network_of({{7.25, 2.75}, {7.5, 6.5}}, {{1, 0, {}, 42}}), grid, alone);
    ASSERT_EQ(carried.network.arc_count(), 1U);
    // Aside first, away from its own river, then straight; of the two sides the west.
    std::vector<Vec2> const expected{{7.5, 6.5}, {7.25, 2.75}, {6.5, 1.5}, {6.5, 0.5}};
    EXPECT_TRUE(carried.network.arc(0).line == expected);
    EXPECT_TRUE((carried.network.node(0).at == Vec2{6.5, 0.5}));
    ASSERT_EQ(carried.notes.size(), 1U);
    EXPECT_EQ(carried.notes[0].kind, "carried_outlet");
    EXPECT_EQ(carried.notes[0].feature, 42);
    EXPECT_TRUE((carried.notes[0].where == Vec2{7.25, 2.75}));
    EXPECT_NEAR(carried.notes[0].amount, 1.0 + std::sqrt(0.5625 + 1.5625), 1e-12);
}

TEST(CarryOutlets, SeveralArcsGetATrunk) {
    Grid const grid = test::frame(15, 7);
    NetworkDraft net = test::network_of({{7.5, 2.5}, {5.5, 4.5}, {9.5, 4.5}}, {{1, 0}, {2, 0}}).draft();
    for (DraftArc& drawn : net.arcs) {
        drawn.arc.persistence = drawn.from == 1 ? 3.0 : 4.0;
    }
    auto const carried = carry_outlets(net, grid);
    ASSERT_EQ(carried.network.arc_count(), 3U);
    EXPECT_EQ(kind_of(carried.network, 0), NodeKind::confluence);
    EXPECT_EQ(carried.network.from(2), 0U);
    EXPECT_TRUE((carried.network.node(0).at == Vec2{7.5, 2.5}));
    EXPECT_EQ(carried.network.node(carried.network.to(2)).at.y, 0.5);
    EXPECT_EQ(carried.network.arc(2).persistence, 4.0); // as long as one of the rivers it carries
    EXPECT_EQ(carried.notes[0].feature, 1);             // the arc, where no file named a line
}

TEST(CarryOutlets, AClosedBasinStays) {
    // A ring of rivers around the outlet: they end in a gap too narrow to pass.
    Grid const grid = test::frame(11, 11);
    StreamNetwork const net =
        test::network_of({{5.5, 5.5}, {5.5, 6.5}, {0.5, 2.5}, {2.5, 2.5}},
                         {{1, 0}, {3, 2, {{2.5, 8.5}, {8.5, 8.5}, {8.5, 2.5}, {3.5, 2.5}, {3.5, 0.5}, {0.5, 0.5}}}});
    auto const carried = carry_outlets(net, grid, alone);
    ASSERT_EQ(carried.notes.size(), 1U);
    EXPECT_EQ(carried.notes[0].kind, "closed_basin");
    EXPECT_EQ(carried.network.node(0).at, (Vec2{5.5, 5.5}));

    auto const joined = carry_outlets(net, grid);
    EXPECT_EQ(joined.notes[0].kind, "joined_outlet");
    EXPECT_EQ(joined.network.outlets().size(), 1U);
    EXPECT_EQ(joined.network.arc_count(), 3U);
}

TEST(CarryOutlets, TheCheapestWayWithoutACrossing) {
    ASSERT_TRUE(rc::check("every new segment against every other, exactly; A* = relaxing every step", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const basins = *rc::gen::element<std::size_t>(0, 0, 1, 1, 3, 8); // 0: a skeleton
        StreamNetwork const net = basins > 0 ? scattered_rivers(seed, basins) : test::random_skeleton(seed, 32);
        RC_PRE(net.arc_count() > 0U);
        PlainGround ground{test::frame(32, 32), {}, {}, {}};
        for (ArcId arc = 0; arc < net.arc_count(); ++arc) {
            ground.add(net.arc(arc).line);
        }
        auto const carried = carry_outlets(net, ground.grid, alone);
        auto const ways = ways_of(net, carried);
        std::vector<NodeId> inside;
        for (NodeId const outlet : net.outlets()) {
            if (!ground.grid.on_border(cells_along({net.node(outlet).at}, ground.grid)[0])) {
                inside.push_back(outlet);
            }
        }
        RC_ASSERT(carried.notes.size() == inside.size());
        if (basins == 1 && inside.size() == 1) { // closed only where there is no way
            double const cheapest = ground.cheapest(net.node(inside[0]).at);
            RC_ASSERT(std::isinf(cheapest) == (carried.notes[0].kind == "closed_basin"));
            RC_ASSERT(std::isinf(cheapest) == ways.empty());
            RC_ASSERT((ways.empty() || std::fabs(ground.cost_of(ways[0]) - cheapest) <= 1e-6));
        }
        for (auto const& way : ways) {
            std::vector<Cell> const cells = cells_along(way, ground.grid);
            RC_ASSERT(ground.grid.on_border(cells.back()));
            auto const own = pieces_of(way);
            for (std::size_t i = 0; i < own.size(); ++i) {
                for (Piece const& other : ground.pieces) {
                    RC_ASSERT(!conflict(own[i], other));
                    // Only the old outlet may be touched.
                    RC_ASSERT((i == 0 || !meet(own[i], other)));
                }
                for (std::size_t k = 0; k < i; ++k) {
                    RC_ASSERT(!conflict(own[i], own[k]));
                    RC_ASSERT((k + 1 == i || !meet(own[i], own[k])));
                }
            }
            for (std::size_t i = 1; i < cells.size(); ++i) {
                RC_ASSERT(!ground.river.contains(ground.grid.index(cells[i])));
                if (cells[i].col != cells[i - 1].col && cells[i].row != cells[i - 1].row) {
                    auto const a = ground.grid.index({cells[i].col, cells[i - 1].row});
                    auto const b = ground.grid.index({cells[i - 1].col, cells[i].row});
                    RC_ASSERT(!ground.diagonal.contains(std::minmax(a, b)));
                }
            }
            ground.add(way); // the next one keeps off this one
        }
    }));
}

TEST(CarryOutlets, RiversThatAreJoinedAreTreesWithoutCrossings) {
    ASSERT_TRUE(rc::check("many strokes", [] {
        Grid const grid = test::frame(64, 64);
        RandomStream words(*rc::gen::arbitrary<std::uint64_t>(), 4, 0);
        std::vector<Vec2> nodes;
        std::vector<test::Reach> reaches;
        for (std::int64_t k = 0; k < 49; ++k) { // short level lines, some cells from one another
            Cell const from{4 + 8 * (k % 7) + static_cast<std::int64_t>(words.word() % 3), 5 + 8 * (k / 7)};
            if (words.word() % 3 > 0) {
                for (std::int64_t const col : {from.col, from.col + 3}) {
                    nodes.push_back(grid.centre({col, from.row}));
                }
                reaches.push_back({nodes.size() - 2, nodes.size() - 1});
            }
        }
        auto const carried = carry_outlets(test::network_of(nodes, reaches), grid);
        for (NodeId const outlet : carried.network.outlets()) {
            RC_ASSERT(grid.on_border(cells_along({carried.network.node(outlet).at}, grid)[0]));
        }
        RC_ASSERT(carried.network.upstream_order().size() == carried.network.node_count());
        RC_ASSERT(test::meetings_of(carried.network).empty());
    }));
}

} // namespace carry_outlets_test
