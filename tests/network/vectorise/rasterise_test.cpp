// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/rasterise.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/elevation/set_heights.hpp>

namespace rasterise_test {

namespace {

using namespace thalweg;
using network::rasterise;
using test::full_message_of;

ElevatedNetwork raised(StreamNetwork const& net, std::vector<std::vector<double>> arc_z) {
    return {net, std::vector<double>(net.node_count(), 0.0), std::move(arc_z)};
}

std::string refusal(ElevatedNetwork const& net, Grid const& grid) {
    return full_message_of<BadInput>([&] { rasterise(net, grid); });
}

/// All cells of all arcs, downstream, from the lowest height on each: lowered by sweeps until none rises.
std::map<std::int64_t, float> plain_valley(ElevatedNetwork const& net, Grid const& grid, std::int64_t& lowered) {
    std::map<std::int64_t, float> z;
    std::vector<std::vector<std::int64_t>> paths;
    for (std::size_t a = 0; a < net.plan.arc_count(); ++a) {
        std::vector<Vec2> const& line = net.plan.arc(a).line;
        std::vector<std::int64_t> path;
        for (std::size_t i = 1; i < line.size(); ++i) {
            std::vector<Cell> const cells = cells_along({line[i - 1], line[i]}, grid);
            for (std::size_t k = 0; k < cells.size(); ++k) {
                double const t =
                    cells.size() == 1 ? 1.0 : static_cast<double>(k) / static_cast<double>(cells.size() - 1);
                double const up = net.arc_z[a][i - 1];
                double const down = net.arc_z[a][i];
                for (double const here : {t == 1.0 ? down : up + (down - up) * t, cells.size() == 1 ? up : down}) {
                    if (here == down && t != 1.0) {
                        continue;
                    }
                    auto const at = z.try_emplace(grid.index(cells[k]), static_cast<float>(here)).first;
                    at->second = std::min(at->second, static_cast<float>(here));
                }
                path.push_back(grid.index(cells[k]));
            }
        }
        paths.push_back(path);
    }
    auto const before = z;
    for (bool changed = true; changed;) {
        changed = false;
        for (auto const& path : paths) {
            for (std::size_t i = 1; i < path.size(); ++i) {
                if (z[path[i]] > z[path[i - 1]]) {
                    z[path[i]] = z[path[i - 1]];
                    changed = true;
                }
            }
        }
    }
    lowered = std::count_if(before.begin(), before.end(), [&](auto const& c) { return z[c.first] != c.second; });
    return z;
}

} // namespace

TEST(Rasterise, AnEmptyNetworkIsAnEmptyValley) {
    auto const out = rasterise({}, test::frame(3, 2));
    for (float const v : out.valley.z.values()) {
        EXPECT_TRUE(std::isnan(v));
    }
}

TEST(Rasterise, OutsideTheGrid) {
    Grid const grid = test::frame(4, 4);
    StreamNetwork const net = test::network_of({{0.5, 0.5}, {2.5, 2.5}, {5, 1}}, {{1, 0}, {2, 1}});
    EXPECT_TRUE(test::has(refusal(raised(net, {{1, 0}, {2, 1}}), grid), "vertex 0 of arc 2 at"));
    EXPECT_TRUE(test::has(refusal(raised(test::network_of({{1, 1}, {NAN, 1}}, {{1, 0}}), {{1, 0}}), grid), "outside"));
    EXPECT_TRUE(
        test::has(refusal(raised(test::network_of({{1, 1}, {1e300, 1}}, {{1, 0}}), {{1, 0}}), grid), "outside"));
}

TEST(Rasterise, HeightsThatDoNotFit) {
    Grid const grid = test::frame(4, 4);
    StreamNetwork const net = test::network_of({{0.5, 0.5}, {2.5, 2.5}}, {{1, 0}});
    EXPECT_NE(refusal(raised(net, {}), grid), "");
    EXPECT_NE(refusal(raised(net, {{1.0}}), grid), "");
    EXPECT_TRUE(test::has(refusal(raised(net, {{NAN, 1.0}}), grid), "not a number"));
}

TEST(Rasterise, TheOuterEdgesBelongToTheOutermostCells) {
    Grid const grid = test::frame(4, 3);
    EXPECT_EQ(cells_along({{4.0, 0.0}}, grid), (std::vector<Cell>{{3, 2}}));
    EXPECT_EQ(cells_along({{0.0, 3.0}}, grid), (std::vector<Cell>{{0, 0}}));
    EXPECT_THROW(cells_along({{4.0000001, 1.0}}, grid), BadInput);
    EXPECT_THROW(cells_along({{-1e-9, 1.0}}, grid), BadInput);
    EXPECT_THROW(cells_along({{1.0, 3.0000001}}, grid), BadInput);
    EXPECT_THROW(cells_along({{1.0, -1e-9}}, grid), BadInput);
}

TEST(Rasterise, LinearBetweenVerticesAndLowestWhereShared) {
    Grid const grid = test::frame(5, 3);
    // Two rivers: one along the middle row, one down the column of its third cell.
    StreamNetwork const net = test::network_of({{0.5, 1.5}, {4.5, 1.5}, {2.5, 2.5}, {2.5, 0.5}}, {{1, 0}, {2, 3}});
    auto const out = rasterise(raised(net, {{8, 4}, {2, 1}}), grid);
    std::vector<float> const middle(out.valley.z.row(1).begin(), out.valley.z.row(1).end());
    EXPECT_EQ(middle, (std::vector<float>{1.5F, 1.5F, 1.5F, 7.0F, 8.0F})); // 4 5 6 7 8 lowered where it meets the other
    EXPECT_EQ(out.lowered_cells, 2);
    EXPECT_EQ(out.max_lowered_m, 3.5);
}

TEST(Rasterise, CellsOfALine) {
    ASSERT_TRUE(rc::check("8-connected, as many steps as the longer side, half a cell from the line", [] {
        Grid const grid = test::frame(60, 50);
        auto const place = [] {
            return Vec2{*rc::gen::inRange<int>(0, 601) / 10.0, *rc::gen::inRange<int>(0, 501) / 10.0};
        };
        Vec2 const a = place();
        Vec2 const b = place();
        std::vector<Cell> const cells = cells_along({a, b}, grid);
        Cell const from = cells_along({a}, grid)[0];
        Cell const to = cells_along({b}, grid)[0];
        auto const dx = static_cast<double>(to.col - from.col);
        auto const dy = static_cast<double>(to.row - from.row);
        double const n = std::max(std::fabs(dx), std::fabs(dy));
        RC_ASSERT(cells.front() == from);
        RC_ASSERT(cells.back() == to);
        RC_ASSERT(static_cast<double>(cells.size()) == n + 1.0);
        for (std::size_t k = 1; k < cells.size(); ++k) {
            double const x = static_cast<double>(from.col) + dx * static_cast<double>(k) / n;
            double const y = static_cast<double>(from.row) + dy * static_cast<double>(k) / n;
            RC_ASSERT(std::fabs(static_cast<double>(cells[k].col) - x) <= 0.5 + 1e-9);
            RC_ASSERT(std::fabs(static_cast<double>(cells[k].row) - y) <= 0.5 + 1e-9);
            RC_ASSERT(std::abs(cells[k].col - cells[k - 1].col) <= 1);
            RC_ASSERT(std::abs(cells[k].row - cells[k - 1].row) <= 1);
        }
    }));
}

TEST(Rasterise, NoPathRises) {
    ASSERT_TRUE(rc::check("rivers that share cells: worklist = sweeps to a fixpoint", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        StreamNetwork const net =
            test::random_forest(seed, *rc::gen::inRange<std::size_t>(0, 20), *rc::gen::inRange<std::size_t>(1, 4));
        auto const side = *rc::gen::inRange<std::int64_t>(5, 40);
        Grid const grid{side, side, 1000.0 / static_cast<double>(side), 0.0, 1000.0, ""};
        bool const repaired = *rc::gen::arbitrary<bool>();
        auto const heights = network::set_heights(
            net, {repaired ? network::HeightMode::straight_repaired : network::HeightMode::straight});
        std::int64_t lowered = 0;
        auto const expected = plain_valley(heights.network, grid, lowered);
        auto const out = rasterise(heights.network, grid);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            auto const at = expected.find(i);
            RC_ASSERT(std::isnan(out.valley.z[i]) == (at == expected.end()));
            RC_ASSERT((at == expected.end() || out.valley.z[i] == at->second));
        }
        RC_ASSERT(out.lowered_cells == lowered);
    }));
}

TEST(Rasterise, ASkeletonGetsItsOwnCellsBack) {
    ASSERT_TRUE(rc::check("cells of a traced skeleton, nothing to lower", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        StreamNetwork const net = test::random_skeleton(seed, 32);
        auto const out = rasterise(network::set_heights(net).network, test::frame(32, 32));
        std::int64_t cells = 0;
        std::int64_t vertices = static_cast<std::int64_t>(net.outlets().size());
        for (float const v : out.valley.z.values()) {
            cells += std::isnan(v) ? 0 : 1;
        }
        for (ArcId arc = 0; arc < net.arc_count(); ++arc) {
            vertices += static_cast<std::int64_t>(net.arc(arc).line.size()) - 1;
        }
        RC_ASSERT(cells == vertices);
        RC_ASSERT(out.lowered_cells == 0);
    }));
}

} // namespace rasterise_test
