// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/meander.hpp>

#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/network/order/order.hpp>

namespace meander_test {

namespace {

using namespace thalweg;
using network::meander;
using network::MeanderedNetwork;
using test::meetings_of;

/// Areas that grow downstream: a hundred cells for each source.
std::vector<double> some_areas(StreamNetwork const& net, Grid const& grid) {
    std::vector<double> out;
    for (std::int64_t const sources : network::order(net).shreve) {
        out.push_back(100.0 * static_cast<double>(sources) * grid.cell_m * grid.cell_m);
    }
    return out;
}

/// Rivers on a square lattice of four cells' width: they do not cross.
StreamNetwork lattice_rivers(std::uint64_t seed, Grid const& grid) {
    NetworkDraft net = test::random_skeleton(seed, grid.width / 4).draft();
    auto const placed = [&](Vec2 p) { return Vec2{grid.west, grid.south()} + 4.0 * grid.cell_m * p; };
    for (auto& node : net.nodes) {
        node.at = placed(node.at);
    }
    for (DraftArc& drawn : net.arcs) {
        drawn.arc.feature = static_cast<std::int64_t>(drawn.from);
        std::ranges::transform(drawn.arc.line, drawn.arc.line.begin(), placed);
    }
    return net;
}

/// The least distance of a vertex of one arc to a segment of the other.
double least_distance(std::vector<Vec2> const& a, std::vector<Vec2> const& b) {
    double least = 1e300;
    for (Vec2 const p : a) {
        for (std::size_t j = 1; j < b.size(); ++j) {
            least = std::min(least, distance(p, geometry::foot_on(b[j - 1], b[j], p).at));
        }
    }
    return least;
}

Grid hundred_cells() {
    Grid grid = test::frame(100, 100);
    grid.cell_m = 30.0;
    grid.west = 500000.0;
    grid.north = 5000000.0;
    return grid;
}

TEST(Meander, RefusesWhatItCannotBend) {
    Grid const grid = test::frame(10, 10);
    StreamNetwork const net = test::network_of({{5.0, 0.0}, {5.0, 9.0}}, {{1, 0}});
    EXPECT_THROW(meander(net, grid, {1.0}, {.gain = 2.1}), BadParameter);
    EXPECT_THROW(meander(net, grid, {1.0}, {.gap_cells = 0.1}), BadParameter);
    StreamNetwork const cross = test::network_of({{5.0, 0.0}, {5.0, 9.0}, {1.0, 4.0}, {9.0, 4.0}}, {{1, 0}, {2, 3}});
    StreamNetwork const point = test::network_of({{5.0, 0.0}, {5.0, 0.0}}, {{1, 0}});
    for (auto const& [wrong, cells, areas] : std::vector<std::tuple<StreamNetwork, std::int64_t, std::vector<double>>>{
             {net, 10, {}}, {net, 10, {-1.0}}, {net, 5, {1.0}}, {cross, 10, {1.0, 1.0}}, {point, 10, {1.0}}}) {
        EXPECT_THROW(meander(wrong, test::frame(cells, cells), areas), BadInput);
    }
    EXPECT_EQ(meander({}, grid, {}).network.arc_count(), 0U);
}

TEST(Meander, AStraightRiverIsStraightNoLonger) {
    Grid const grid = hundred_cells();
    Vec2 const mouth{grid.west + 1500.0, grid.south()};
    StreamNetwork const net = test::network_of({mouth, {grid.west + 1500.0, grid.north - 300.0}}, {{1, 0}});
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
        MeanderedNetwork const out = meander(net, grid, {9e6}, {.seed = seed});
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
    MeanderedNetwork const out = meander(net, grid, {9e6}, {.gain = 0.0});
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
        MeanderedNetwork const out = meander(net, grid, some_areas(net, grid), {.gain = gain, .seed = seed});
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
                RC_ASSERT((grid.west <= p.x && p.x <= grid.east() && grid.south() <= p.y && p.y <= grid.north));
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
        MeanderedNetwork const out = meander(net, land, some_areas(net, grid), {.seed = seed});
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

TEST(Meander, RandomBendsFollowTheSeed) {
    Grid const grid = hundred_cells();
    StreamNetwork const net = lattice_rivers(3, grid);
    auto const bent = [&](std::uint64_t seed) {
        return meander(net, grid, some_areas(net, grid), {.seed = seed}).network;
    };
    EXPECT_TRUE(test::same_network(bent(1), bent(1)));
    EXPECT_FALSE(test::same_network(bent(1), bent(2)));
}

} // namespace

} // namespace meander_test
