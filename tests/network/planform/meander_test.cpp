// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/meander.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/planform/internal/segment_grid.hpp>

namespace meander_test {

namespace {

using namespace thalweg;
using network::meander;
using network::Meandered;

/// Areas that grow downstream: a hundred cells for each source.
std::vector<double> some_areas(StreamNetwork const& net, Grid const& grid) {
    std::vector<double> out;
    for (std::int64_t const sources : network::order(net).shreve) {
        out.push_back(100.0 * static_cast<double>(sources) * grid.cell_m * grid.cell_m);
    }
    return out;
}

/// Trees of arcs on a square lattice of four cells' width, that pay heed to one another: each begins in a free place
/// and walks to one that is taken.
StreamNetwork lattice_rivers(std::uint64_t seed, Grid const& grid) {
    RandomStream words(seed, 5, 0);
    std::int64_t const side = grid.width / 4;
    std::vector<std::int64_t> down(static_cast<std::size_t>(side * side), -2);
    std::vector<std::int64_t> donors(down.size(), 0);
    auto const at = [&](std::int64_t i) {
        return Vec2{grid.west + (4.0 * static_cast<double>(i % side) + 2.5) * grid.cell_m,
                    grid.south() + 4.0 * static_cast<double>(i / side) * grid.cell_m + (i < side ? 0.0 : 2.0)};
    };
    std::int64_t const mouth = side / 2;
    down[static_cast<std::size_t>(mouth)] = -1;
    for (int river = 0; river < 25; ++river) {
        std::vector<std::int64_t> way{static_cast<std::int64_t>(words.word() % down.size())};
        while (down[static_cast<std::size_t>(way.back())] == -2 && way.size() < 5000) {
            std::int64_t const x = way.back() % side;
            std::int64_t const y = way.back() / side;
            auto const turn = words.word() % 5;
            std::int64_t const nx = x + (turn == 0 ? 1 : turn == 1 ? -1 : 0);
            std::int64_t const ny = y + (turn > 2 ? -1 : turn == 2 ? 1 : 0);
            if (nx < 0 || nx >= side || ny < 0 || ny >= side || (ny == 0 && nx != mouth)) {
                continue;
            }
            std::int64_t const next = ny * side + nx;
            auto const been = std::find(way.begin(), way.end(), next);
            if (been != way.end()) {
                way.erase(been + 1, way.end());
            } else {
                way.push_back(next);
            }
        }
        if (down[static_cast<std::size_t>(way.back())] == -2 || way.front() < side) {
            continue;
        }
        for (std::size_t i = 0; i + 1 < way.size(); ++i) {
            down[static_cast<std::size_t>(way[i])] = way[i + 1];
            ++donors[static_cast<std::size_t>(way[i + 1])];
        }
    }
    NetworkDraft net;
    std::vector<NodeId> node(down.size(), 0);
    auto const is_node = [&](std::size_t i) { return down[i] == -1 || (down[i] >= 0 && donors[i] != 1); };
    for (std::size_t i = 0; i < down.size(); ++i) {
        if (is_node(i)) {
            node[i] = net.add_node(at(static_cast<std::int64_t>(i)));
        }
    }
    for (std::size_t i = 0; i < down.size(); ++i) {
        if (!is_node(i) || down[i] < 0) {
            continue;
        }
        Arc arc;
        arc.feature = static_cast<std::int64_t>(i);
        std::size_t j = i;
        do {
            arc.line.push_back(at(static_cast<std::int64_t>(j)));
            j = static_cast<std::size_t>(down[j]);
        } while (!is_node(j));
        arc.line.push_back(at(static_cast<std::int64_t>(j)));
        net.add_arc(node[i], node[j], std::move(arc));
    }
    return net;
}

std::vector<geometry::Meeting> meetings_of(StreamNetwork const& net) {
    std::vector<std::vector<Vec2>> lines;
    std::vector<geometry::EndNodes> nodes;
    for (std::size_t a = 0; a < net.arc_count(); ++a) {
        lines.push_back(net.arc(a).line);
        nodes.push_back({net.from(a), net.to(a)});
    }
    return geometry::meetings(lines, nodes);
}

/// The least distance of a vertex of one arc to a segment of the other.
double least_distance(std::vector<Vec2> const& a, std::vector<Vec2> const& b) {
    double least = 1e300;
    for (Vec2 const p : a) {
        for (std::size_t j = 1; j < b.size(); ++j) {
            least = std::min(least, network::squared_distance(p, {b[j - 1], b[j]}));
        }
    }
    return std::sqrt(least);
}

Grid hundred_cells() {
    Grid grid = test::frame(100, 100);
    grid.cell_m = 30.0;
    grid.west = 500000.0;
    grid.north = 5000000.0;
    return grid;
}

TEST(Meander, NothingIsNothing) {
    EXPECT_EQ(meander({}, test::frame(5, 5), {}).network.arc_count(), 0U);
}

TEST(Meander, RefusesWhatItCannotBend) {
    Grid const grid = test::frame(10, 10);
    StreamNetwork const net = test::network_of({{5.0, 0.0}, {5.0, 9.0}}, {{1, 0}});
    EXPECT_THROW(meander(net, grid, {1.0}, {.gain = 2.1}), BadParameter);
    EXPECT_THROW(meander(net, grid, {1.0}, {.gap_cells = 0.1}), BadParameter);
    EXPECT_THROW(meander(net, grid, {}), BadInput);
    EXPECT_THROW(meander(net, grid, {-1.0}), BadInput);
    EXPECT_THROW(meander(net, test::frame(5, 5), {1.0}), BadInput);
    StreamNetwork const cross = test::network_of({{5.0, 0.0}, {5.0, 9.0}, {1.0, 4.0}, {9.0, 4.0}}, {{1, 0}, {2, 3}});
    EXPECT_THROW(meander(cross, grid, {1.0, 1.0}), BadInput);
    StreamNetwork const point = test::network_of({{5.0, 0.0}, {5.0, 0.0}}, {{1, 0}});
    EXPECT_THROW(meander(point, grid, {1.0}), BadInput);
}

TEST(Meander, AStraightRiverIsStraightNoLonger) {
    Grid const grid = hundred_cells();
    Vec2 const mouth{grid.west + 1500.0, grid.south()};
    StreamNetwork const net = test::network_of({mouth, {grid.west + 1500.0, grid.north - 300.0}}, {{1, 0}});
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
        Meandered const out = meander(net, grid, {9e6}, {.seed = seed});
        auto const& line = out.network.arc(0).line;
        double const sinuosity = length_of(line) / distance(line.front(), line.back());
        EXPECT_GT(sinuosity, 1.02) << seed;
        EXPECT_LT(sinuosity, 1.6) << seed;
        EXPECT_EQ(line.back(), mouth);
    }
}

TEST(Meander, RoundedStepsStayWithinHalfACell) {
    Grid const grid = hundred_cells();
    std::vector<Vec2> steps;
    for (int i = 0; i <= 40; ++i) {
        steps.push_back({grid.west + 30.0 * (10.0 + i / 2), grid.north - 30.0 * (20.0 + (i + 1) / 2)});
    }
    StreamNetwork const net =
        test::network_of({steps.front(), steps.back()}, {{0, 1, {steps.begin() + 1, steps.end() - 1}}});
    Meandered const out = meander(net, grid, {9e6}, {.gain = 0.0});
    auto const& line = out.network.arc(0).line;
    EXPECT_LE(out.max_shift_m, 15.0 + 1e-6);
    EXPECT_LT(length_of(line), 1.1 * distance(line.front(), line.back()));
    EXPECT_GT(length_of(steps), 1.4 * distance(line.front(), line.back()));
}

TEST(Meander, TheSameTreeOfRiversThatDoNotMeet) {
    ASSERT_TRUE(rc::check("on a lattice that leaves little room", [] {
        Grid const grid = hundred_cells();
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        double const gain = *rc::gen::element(0.0, 0.5, 1.0, 2.0);
        StreamNetwork const net = lattice_rivers(seed, grid);
        RC_PRE(net.arc_count() > 0U);
        RC_ASSERT(meetings_of(net).empty());
        Meandered const out = meander(net, grid, some_areas(net, grid), {.gain = gain, .seed = seed});
        RC_ASSERT(out.network.from() == net.from());
        RC_ASSERT(out.network.to() == net.to());
        RC_ASSERT(meetings_of(out.network).empty());
        for (NodeId const n : net.outlets()) {
            RC_ASSERT(out.network.node(n).at == net.node(n).at);
        }
        double shift = 0.0;
        for (std::size_t a = 0; a < out.network.arc_count(); ++a) {
            Arc const& arc = out.network.arc(a);
            RC_ASSERT(arc.feature == net.arc(a).feature);
            RC_ASSERT(arc.line.front() == out.network.node(out.network.from(a)).at);
            RC_ASSERT(arc.line.back() == out.network.node(out.network.to(a)).at);
            for (Vec2 const p : arc.line) {
                RC_ASSERT(grid.west <= p.x);
                RC_ASSERT(p.x <= grid.east());
                RC_ASSERT(grid.south() <= p.y);
                RC_ASSERT(p.y <= grid.north);
            }
            shift = std::max(shift, distance(arc.line.front(), net.arc(a).line.front()));
        }
        RC_ASSERT(shift <= out.max_shift_m + 1e-9);
        if (gain > 0.0) {
            return;
        }
        RC_ASSERT(out.max_shift_m <= 15.0 + 1e-5);
        for (NodeId n = 0; n < net.node_count(); ++n) {
            RC_ASSERT(out.network.node(n).at == net.node(n).at);
        }
        for (std::size_t a = 0; a < out.network.arc_count(); ++a) {
            for (std::size_t b = 0; b < out.network.arc_count(); ++b) {
                if (a != b && least_distance(net.arc(a).line, net.arc(b).line) >= 45.0 &&
                    least_distance(net.arc(b).line, net.arc(a).line) >= 45.0) {
                    RC_ASSERT(least_distance(out.network.arc(a).line, out.network.arc(b).line) >= 45.0 - 1e-5);
                }
            }
        }
    }));
}

TEST(Meander, RiversStayOnLandAndEndWhereTheyEnded) {
    ASSERT_TRUE(rc::check("with an outlet inside the grid, on a coast that runs along some rivers", [] {
        Grid const grid = hundred_cells();
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        StreamNetwork net = lattice_rivers(seed, grid);
        RC_PRE(net.arc_count() > 0U);
        // the last eight cells are sea, but for what the rivers run through
        Mask land = test::raster_of<std::uint8_t>(grid, [&](Cell c) { return c.row < 92 ? 1 : 0; });
        for (ArcId e = 0; e < net.arc_count(); ++e) {
            for (Cell const c : cells_along(net.arc(e).line, grid)) {
                land[c] = 1;
            }
        }
        Meandered const out = meander(net, land, some_areas(net, grid), {.seed = seed});
        RC_ASSERT(meetings_of(out.network).empty());
        for (NodeId const n : net.outlets()) {
            RC_ASSERT(out.network.node(n).at == net.node(n).at);
        }
        for (ArcId e = 0; e < out.network.arc_count(); ++e) {
            for (Vec2 const p : out.network.arc(e).line) {
                Cell const c = grid.cell_of(p);
                RC_ASSERT((!grid.contains(c) || land[c] == 1));
            }
        }
    }));
}

TEST(Meander, AnOutletInsideTheGridStays) {
    Grid const grid = hundred_cells();
    Vec2 const sink{grid.west + 1511.0, grid.south() + 1503.0};
    StreamNetwork const net = test::network_of({sink, {grid.west + 1500.0, grid.north - 300.0}}, {{1, 0}});
    EXPECT_EQ(meander(net, grid, {9e6}).network.node(0).at, sink);
}

TEST(Meander, ChanceIsTheSeeds) {
    Grid const grid = hundred_cells();
    StreamNetwork const net = lattice_rivers(3, grid);
    auto const lines = [&](std::uint64_t seed) {
        StreamNetwork const out = meander(net, grid, some_areas(net, grid), {.seed = seed}).network;
        std::vector<std::vector<Vec2>> all;
        for (ArcId e = 0; e < out.arc_count(); ++e) {
            all.push_back(out.arc(e).line);
        }
        return all;
    };
    EXPECT_EQ(lines(1), lines(1));
    EXPECT_NE(lines(1), lines(2));
}

} // namespace

} // namespace meander_test
