// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/catchments.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <measure/dems.hpp>
#include <measure/trees.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>

namespace catchments_test {

using namespace thalweg;
using flow::areas_d8;
using flow::areas_nearest;
using flow::Catchments;
using flow::catchments;
using flow::ContributingAreas;
using flow::flow_lengths;
using flow::FlowField;
using flow::Reach;
using flow::reaches_of;
using flow::route;

namespace {

using test::has;
using test::message_of;

using Counts = std::vector<std::int64_t>;

/// A valley between two walls that falls to the south by 2 a row, and a side valley from the west into its middle.
Raster<float> small_valley() {
    return dem_of(5, {30, 29, 20, 29, 30, //
                      30, 29, 18, 29, 30, //
                      18, 17, 16, 29, 30, //
                      30, 29, 14, 29, 30, //
                      30, 29, 12, 29, 30});
}

/// Down the middle column, joined from the west in its middle cell; the second part of the last in two pieces.
std::vector<Reach> small_rivers() {
    return {{{{{2.5, 4.5}, {2.5, 2.5}}}, 2, 11},
            {{{{0.5, 2.5}, {2.5, 2.5}}}, 2, 12},
            {{{{2.5, 2.5}, {2.5, 1.5}}, {{2.5, 1.5}, {2.5, 0.5}}}, -1, 13}};
}

std::string complaint_of(std::vector<Reach> const& reaches, FlowField const& drainage) {
    return message_of<BadInput>([&] { catchments(reaches, drainage); });
}

/// Rivers on lattices finer or coarser than the cells, which reaches and nodes then share, and any land with holes
/// under them.
rc::Gen<std::pair<ElevatedNetwork, Raster<float>>> gen_rivers_and_land() {
    return rc::gen::exec([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const cols = *evenly<std::int64_t>(1, 9);
        auto const rows = *evenly<std::int64_t>(2, 9);
        double const spacing = *rc::gen::element(0.3, 0.5, 1.0, 1.7, 3.0);
        auto const cells = [&](std::int64_t points) {
            return static_cast<std::int64_t>(std::ceil(static_cast<double>(points) * spacing)) +
                   *evenly<std::int64_t>(0, 4);
        };
        Raster<float> dem(frame(cells(cols), cells(rows)));
        auto const holes = *evenly<std::uint64_t>(0, 20);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            auto const any = random_word(seed, static_cast<std::uint64_t>(i), 1);
            dem[i] = any % 100 < holes ? hole : static_cast<float>(any / 100 % 9);
        }
        return std::pair{random_rivers(seed, cols, rows, spacing), dem};
    });
}

using Numbers = std::vector<double>;

/// A river down the middle column of five rows, joined from the west in its middle cell.
StreamNetwork small_network() {
    NetworkDraft net;
    auto const north = net.add_node({2.5, 4.5});
    auto const west = net.add_node({0.5, 2.5});
    auto const joint = net.add_node({2.5, 2.5});
    auto const mouth = net.add_node({2.5, 0.5});
    net.add_arc(north, joint);
    net.add_arc(west, joint);
    net.add_arc(joint, mouth);
    return net;
}

/// Areas by walking: which arc each cell of the grid belongs to, and whether an arc's water passes another.
ContributingAreas nearest_slowly(StreamNetwork const& network, Grid const& grid) {
    std::size_t const arcs = network.arc_count();
    auto const next = [&](std::size_t a) { return network.out(network.to(a)); };
    auto const passes = [&](std::size_t a, std::size_t b) {
        ArcId at = a;
        while (at != no_arc && at != b) {
            at = next(at);
        }
        return at != no_arc;
    };
    std::map<std::int64_t, std::pair<std::int64_t, std::size_t>> owner; // cell -> arcs to the outlet, arc
    for (std::size_t a = 0; a < arcs; ++a) {
        std::int64_t depth = 0;
        for (ArcId at = a; at != no_arc; at = next(at)) {
            ++depth;
        }
        for (Cell const c : cells_along(network.arc(a).line, grid)) {
            auto const [it, added] = owner.try_emplace(grid.index(c), depth, a);
            it->second = std::min(it->second, std::pair{depth, a});
        }
    }
    double const cell_m2 = grid.cell_m * grid.cell_m;
    ContributingAreas areas{Numbers(arcs, 0.0), Numbers(arcs, 0.0), Numbers(network.node_count(), 0.0)};
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        std::tuple<std::int64_t, std::int64_t> best{grid.cells() * 4, 0};
        for (auto const& [v, whose] : owner) {
            std::int64_t const apart =
                std::abs(grid.at(i).col - grid.at(v).col) + std::abs(grid.at(i).row - grid.at(v).row);
            best = std::min(best, std::tuple{apart, v});
        }
        std::int64_t const cell = std::get<1>(best);
        std::size_t const a = owner.at(cell).second;
        bool const at_start = cell == grid.index(grid.cell_of(network.node(network.from(a)).at));
        for (std::size_t b = 0; b < arcs; ++b) {
            if (passes(a, b)) {
                areas.ds_area_m2[b] += cell_m2;
                areas.us_area_m2[b] += a != b || at_start ? cell_m2 : 0.0;
            }
        }
    }
    for (std::size_t b = 0; b < arcs; ++b) {
        areas.node_m2[network.from(b)] = areas.us_area_m2[b];
        areas.node_m2[network.to(b)] += next(b) == no_arc ? areas.ds_area_m2[b] : 0.0;
    }
    return areas;
}

} // namespace

TEST(Catchments, NoRiversNoCatchments) {
    FlowField const drainage = route(small_valley());
    Catchments const none = catchments({}, drainage);
    EXPECT_TRUE(none.cells.empty());
    EXPECT_EQ(none.without, 25);
    EXPECT_EQ(none.reach[7], -1);
    EXPECT_EQ(catchments({{{}, -1}}, drainage).cells, Counts{0});
}

TEST(Catchments, RefusesCirclesGapsAndLinesOutside) {
    FlowField const drainage = route(small_valley());
    std::vector<Reach> reaches = small_rivers();
    reaches[2].ds = 0;
    EXPECT_TRUE(test::has(complaint_of(reaches, drainage), "arc 11 leads to no outlet"));
    reaches[2].ds = 7;
    EXPECT_TRUE(test::has(complaint_of(reaches, drainage), "arc 13 runs into reach 7 of 3"));
    reaches = small_rivers();
    reaches[1].lines[0][0].x = -0.5;
    EXPECT_TRUE(test::has(complaint_of(reaches, drainage), "of arc 12 at (-0.500, 2.500) lies outside"));
}

TEST(Catchments, SmallValley) {
    Catchments const c = catchments(small_rivers(), route(small_valley()));
    std::vector<int> const reach{c.reach.values().begin(), c.reach.values().end()};
    // The confluence's cell belongs to the reach below it. The north-western corner falls to the east and on into
    // reach 1; of the western wall below the side valley, one cell falls back into it and one on to the main valley.
    EXPECT_EQ(reach, (std::vector<int>{0, 0, 0, 0, 0, //
                                       1, 1, 0, 0, 0, //
                                       1, 1, 2, 2, 2, //
                                       1, 2, 2, 2, 2, //
                                       2, 2, 2, 2, 2}));
    EXPECT_EQ(c.cells, (Counts{8, 5, 12}));
    EXPECT_EQ(c.upstream, (Counts{8, 5, 25}));
    EXPECT_EQ(c.without, 0);
}

TEST(Catchments, FollowTheDefinitionAndAgreeWithAreas) {
    ASSERT_TRUE(rc::check("each cell belongs to the owner of the first river cell below it; areas agree", [] {
        auto const [rivers, dem] = *gen_rivers_and_land();
        Grid const& grid = dem.grid();
        FlowField const drainage = route(dem);
        auto const reaches = reaches_of(rivers.planform);
        Catchments const c = catchments(reaches, drainage);
        std::map<std::int64_t, std::pair<std::int64_t, std::size_t>> owner; // cell -> steps to the outlet, arc
        for (std::size_t a = 0; a < reaches.size(); ++a) {
            std::int64_t steps = 0;
            for (auto at = static_cast<std::int64_t>(a); at >= 0; at = reaches[static_cast<std::size_t>(at)].ds) {
                ++steps;
            }
            for (Cell const cell : cells_along(reaches[a].lines[0], grid)) {
                auto const [it, added] = owner.try_emplace(grid.index(cell), steps, a);
                it->second = std::min(it->second, std::pair{steps, a});
            }
        }
        Counts count(reaches.size(), 0);
        std::int64_t without = 0;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            std::int64_t at = std::isnan(dem[i]) ? -1 : i;
            while (at >= 0 && owner.count(at) == 0) {
                flow::Direction const way = drainage.direction[at];
                at = goes_on(way) ? grid.index({grid.at(at).col + d8_steps[index_of(way)].col,
                                                grid.at(at).row + d8_steps[index_of(way)].row})
                                  : -1;
            }
            auto const whose = at < 0 ? -1 : static_cast<std::int32_t>(owner.at(at).second);
            RC_ASSERT(c.reach[i] == whose);
            without += at < 0 && !std::isnan(dem[i]) ? 1 : 0;
            if (at >= 0) {
                ++count[owner.at(at).second];
            }
        }
        RC_ASSERT(c.cells == count);
        RC_ASSERT(c.without == without);
        auto const areas = flow::areas_d8(rivers.planform, drainage);
        for (std::size_t a = 0; a < reaches.size(); ++a) {
            RC_ASSERT(areas.ds_area_m2[a] == static_cast<double>(c.upstream[a]) * grid.cell_m * grid.cell_m);
        }
    }));
}

TEST(AreasNearest, NoRiversNoAreas) {
    ContributingAreas const areas = areas_nearest({}, frame(3, 3));
    EXPECT_TRUE(areas.us_area_m2.empty());
    EXPECT_TRUE(areas.node_m2.empty());
    NetworkDraft lonely;
    lonely.add_node({0.5, 0.5});
    EXPECT_EQ(areas_nearest(lonely, frame(3, 3)).node_m2, Numbers{0.0});
}

TEST(AreasNearest, RefusesWhatIsNoTreeOrOutside) {
    StreamNetwork net = small_network();
    EXPECT_TRUE(has(message_of<BadInput>([&] { areas_nearest(net, frame(5, 4)); }), "arc 1"));
    NetworkDraft divided = net.draft();
    divided.add_arc(2, 1);
    EXPECT_THROW(areas_nearest(divided, frame(5, 5)), BadInput);
    NetworkDraft circle;
    for (double const x : {0.5, 1.5}) {
        circle.add_node({x, 0.5});
    }
    circle.add_arc(0, 1);
    circle.add_arc(1, 0);
    EXPECT_THROW(areas_nearest(circle, frame(5, 5)), BadInput);
}

TEST(AreasNearest, SmallRivers) {
    // By column and row from the north-west: arc 1 owns (2,0), (2,1), arc 2 (0,2), (1,2), arc 3 the rest of column 2.
    // Of the cells that are as near to two, (0,0) goes to (2,0), (1,1) to (2,1), (1,3) to (1,2) and (0,4) to (0,2).
    Grid grid = frame(5, 5);
    ContributingAreas const areas = areas_nearest(small_network(), grid);
    EXPECT_EQ(areas.us_area_m2, (Numbers{5, 4, 18}));
    EXPECT_EQ(areas.ds_area_m2, (Numbers{9, 6, 25}));
    EXPECT_EQ(areas.node_m2, (Numbers{5, 4, 18, 25}));
    EXPECT_EQ(areas.source, "nearest");
    grid.cell_m = 10.0;
    grid.north = 50.0;
    NetworkDraft wide = small_network().draft();
    for (Node& node : wide.nodes) {
        node.at = {node.at.x * 10.0, node.at.y * 10.0};
    }
    EXPECT_EQ(areas_nearest(wide, grid).ds_area_m2, (Numbers{900, 600, 2500}));
}

TEST(AreasNearest, FollowTheDefinitionAndItsLaws) {
    ASSERT_TRUE(rc::check("areas are those found by walking, and grow downstream to the whole grid", [] {
        auto const [rivers, land] = *gen_rivers_and_land();
        StreamNetwork const& network = rivers.planform;
        Grid const& grid = land.grid();
        ContributingAreas const fast = areas_nearest(network, grid);
        ContributingAreas const slow = nearest_slowly(network, grid);
        RC_ASSERT(fast.us_area_m2 == slow.us_area_m2);
        RC_ASSERT(fast.ds_area_m2 == slow.ds_area_m2);
        RC_ASSERT(fast.node_m2 == slow.node_m2);

        double at_outlets = 0.0;
        for (NodeId const n : network.outlets()) {
            at_outlets += fast.node_m2[n];
        }
        RC_ASSERT(at_outlets == static_cast<double>(grid.cells()));
        for (std::size_t a = 0; a < network.arc_count(); ++a) {
            RC_ASSERT(fast.us_area_m2[a] <= fast.ds_area_m2[a]);
            double arriving = 0.0;
            for (auto const b : network.in(network.from(a))) {
                arriving += fast.ds_area_m2[static_cast<std::size_t>(b)];
            }
            RC_ASSERT(arriving <= fast.us_area_m2[a]);
        }
    }));
}

TEST(AreasD8, SmallRiversInTheirValley) {
    // The bed falls by 2 a row and along the tributary by 1 a column; the banks fall towards the beds.
    Raster<float> const dem = dem_of(5, {30, 29, 20, 29, 30, //
                                         30, 29, 18, 29, 30, //
                                         18, 17, 16, 29, 30, //
                                         30, 29, 14, 29, 30, //
                                         30, 29, 12, 29, 30});
    auto const drainage = flow::route(dem);
    ContributingAreas const areas = areas_d8(small_network(), drainage);
    auto const& d8 = drainage.area_cells;
    auto const at = [&](std::int64_t col, std::int64_t row) { return static_cast<double>(d8[Cell{col, row}]); };
    // The tributary stays a river to its confluence, though the DEM is steepest diagonally past it.
    EXPECT_EQ(at(2, 2), 11.0);
    EXPECT_EQ(areas.us_area_m2, (Numbers{at(2, 0), at(0, 2), 16.0}));
    EXPECT_EQ(areas.ds_area_m2, (Numbers{at(2, 1), at(1, 2), at(2, 4)}));
    EXPECT_EQ(areas.node_m2, (Numbers{at(2, 0), at(0, 2), 16.0, at(2, 4)}));
    EXPECT_EQ(areas.node_m2.back(), 25.0);
    EXPECT_EQ(areas.source, "d8");
}

TEST(AreasD8, ArcInsideOneCellAndNodesOffTheGrid) {
    NetworkDraft net;
    for (double const y : {0.9, 0.5, 0.1}) {
        net.add_node({0.5, y});
    }
    net.add_arc(0, 1);
    net.add_arc(1, 2);
    auto const drainage = flow::route(dem_of(2, {1, 2}));
    EXPECT_EQ(areas_d8(net, drainage).us_area_m2, (Numbers{0, 2}));
    EXPECT_EQ(areas_d8(net, drainage).ds_area_m2, (Numbers{0, 2}));
    net.add_node({0.5, 7.0});
    net.add_arc(3, 0);
    EXPECT_THROW(areas_d8(net, drainage), BadInput);
}

TEST(AreasD8, WaterOfARiverStaysInItWhereTheDemLeavesIt) {
    // Beside the river's second cell stands a lower bank, and beyond it the edge: D8 leaves the river there.
    Raster<float> const dem = dem_of(5, {30, 29, 20, 29, 30, //
                                         30, 29, 18, 5,  4,  //
                                         30, 29, 16, 29, 30, //
                                         30, 29, 14, 29, 30, //
                                         30, 29, 12, 29, 30});
    NetworkDraft net;
    net.add_node({2.5, 4.5});
    net.add_node({2.5, 0.5});
    net.add_arc(0, 1);
    auto const drainage = flow::route(dem);
    ContributingAreas const areas = areas_d8(net, drainage);
    EXPECT_LT((drainage.area_cells[Cell{2, 4}]), 15) << "the upper river is lost to the accumulation of the DEM";
    EXPECT_GE(areas.ds_area_m2[0], 15.0);
}

TEST(AreasD8, FollowTheDefinitionAndItsLaws) {
    ASSERT_TRUE(rc::check("every cell counts where its water first meets a river, and stays in it", [] {
        auto const [rivers, dem] = *gen_rivers_and_land();
        StreamNetwork const& net = rivers.planform;
        Grid const& grid = dem.grid();
        auto const drainage = flow::route(dem);
        ContributingAreas const areas = areas_d8(net, drainage);

        std::set<std::int64_t> river;
        for (std::size_t a = 0; a < net.arc_count(); ++a) {
            for (Cell const c : cells_along(net.arc(a).line, grid)) {
                river.insert(grid.index(c));
            }
            RC_ASSERT(areas.us_area_m2[a] <= areas.ds_area_m2[a]);
            double arriving = 0.0;
            for (ArcId const up : net.in(net.from(a))) {
                arriving += areas.ds_area_m2[up];
            }
            RC_ASSERT(arriving <= areas.us_area_m2[a]);
        }
        std::int64_t reaching = 0;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            std::int64_t at = i;
            while (river.count(at) == 0 && goes_on(drainage.direction[at])) {
                Cell const step = d8_steps[index_of(drainage.direction[at])];
                at = grid.index({grid.at(at).col + step.col, grid.at(at).row + step.row});
            }
            reaching += river.count(at) != 0 && !std::isnan(dem[i]) ? 1 : 0;
        }
        double outlets = 0.0;
        for (NodeId const n : net.outlets()) {
            outlets += areas.node_m2[n];
        }
        RC_ASSERT(outlets == static_cast<double>(reaching) * grid.cell_m * grid.cell_m);
    }));
}

TEST(FlowLengths, AreZeroWithoutDataAndWhereNoWaterArrives) {
    for (Raster<float> const& dem : {Raster<float>(frame(3, 2), hole), dem_of(1, {4})}) {
        Raster<float> const lengths = flow_lengths(route(dem));
        for (float const length : lengths.values()) {
            EXPECT_EQ(length, 0.0F);
        }
    }
}

TEST(FlowLengths, AreTheLongestWayDownToACell) {
    ASSERT_TRUE(rc::check("as walking down from every cell finds", [] {
        Raster<float> const dem = *gen_dem(12, 20);
        FlowField const drainage = route(dem);
        Grid const& grid = dem.grid();
        std::vector<double> longest(static_cast<std::size_t>(grid.cells()), 0.0);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            double length = 0.0;
            for (std::int64_t at = i; goes_on(drainage.direction[at]);) {
                Cell const step = d8_steps[index_of(drainage.direction[at])];
                length += grid.cell_m * std::sqrt(static_cast<double>(step.col * step.col + step.row * step.row));
                at += step.row * grid.width + step.col;
                double& here = longest[static_cast<std::size_t>(at)];
                here = std::max(here, length);
            }
        }
        auto const fast = flow_lengths(drainage);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            double const slow = longest[static_cast<std::size_t>(i)];
            RC_ASSERT(std::fabs(static_cast<double>(fast[i]) - slow) <= 1e-5 * slow);
        }
    }));
}

} // namespace catchments_test
