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

ElevatedNetwork raised(StreamNetwork const& net, std::vector<std::vector<double>> arc_z) {
    return {net, std::vector<double>(net.node_count(), 0.0), std::move(arc_z)};
}

/// All cells of all arcs, downstream, from the lowest height on each: lowered by sweeps until none rises.
std::map<std::int64_t, float> plain_valley(ElevatedNetwork const& net, Grid const& grid, std::int64_t& lowered) {
    std::map<std::int64_t, float> z;
    std::vector<std::vector<std::int64_t>> paths;
    for (std::size_t a = 0; a < net.planform.arc_count(); ++a) {
        std::vector<Vec2> const& line = net.planform.arc(a).line;
        std::vector<std::int64_t> path;
        for (std::size_t i = 1; i < line.size(); ++i) {
            std::vector<Cell> const cells = cells_along({line[i - 1], line[i]}, grid);
            double const up = net.arc_z[a][i - 1];
            double const down = net.arc_z[a][i];
            auto const last = static_cast<double>(cells.size() - 1);
            for (std::size_t k = 0; k < cells.size(); ++k) {
                auto const here =
                    static_cast<float>(k == cells.size() - 1 ? std::min(down, k == 0 ? up : down)
                                                             : up + (down - up) * (static_cast<double>(k) / last));
                auto const at = z.try_emplace(grid.index(cells[k]), here).first;
                at->second = std::min(at->second, here);
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

TEST(Rasterise, RefusesRiversOutsideAndHeightsThatDoNotFit) {
    auto const refused = [](std::string const& by, Vec2 from, std::vector<std::vector<double>> const& arc_z) {
        ElevatedNetwork const net = raised(test::network_of({{0.5, 0.5}, from}, {{1, 0}}), arc_z);
        return test::refused(by, [&] { rasterise(net, test::frame(4, 4)); });
    };
    for (Vec2 const outside : {Vec2{5, 1}, Vec2{NAN, 1}, Vec2{1e300, 1}}) {
        EXPECT_TRUE(refused("core.cells_along", outside, {{1, 0}})) << outside.x;
    }
    for (std::vector<std::vector<double>> const& arc_z : {{}, {{1.0}}, std::vector<std::vector<double>>{{NAN, 1.0}}}) {
        EXPECT_TRUE(refused("network.rasterise", {2, 2}, arc_z));
    }
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
