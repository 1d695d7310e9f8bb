// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/paths.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>

namespace paths_test {

using namespace thalweg;

namespace {

/// A rough land with level steps, depressions and perhaps holes.
Raster<float> any_land() {
    auto const seed = *rc::gen::arbitrary<std::uint64_t>();
    Grid const grid = test::frame(*rc::gen::inRange<std::int64_t>(1, 15), *rc::gen::inRange<std::int64_t>(1, 15));
    bool const holes = *rc::gen::arbitrary<bool>();
    Raster<float> dem(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        std::uint64_t const word = random_word(seed, static_cast<std::uint64_t>(i));
        dem[i] = holes && word % 13 == 0 ? std::nanf("") : static_cast<float>(word % 100);
    }
    return dem;
}

} // namespace

TEST(CutByEdge, ACellIsCutWhereAnyUpstreamOfItIsAtTheEdge) {
    ASSERT_TRUE(rc::check("by the definition", [] {
        Raster<float> const dem = any_land();
        Grid const& grid = dem.grid();
        flow::FlowField const drainage = flow::route(dem);
        Mask const cut = flow::cut_by_edge(drainage);
        auto const has_data = [&](Cell c) { return grid.contains(c) && !std::isnan(dem[c]); };
        std::function<bool(std::int64_t)> const is_cut = [&](std::int64_t i) {
            for (Cell const step : d8_steps) {
                Cell const c{grid.at(i).col + step.col, grid.at(i).row + step.row};
                if (!has_data(c) || (drainage.receiver(grid.index(c)) == i && is_cut(grid.index(c)))) {
                    return true;
                }
            }
            return false;
        };
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            RC_ASSERT((cut[i] != 0) == (!std::isnan(dem[i]) && is_cut(i)));
        }
    }));
}

TEST(Paths, LengthsAndHeightsFollowTheWater) {
    ASSERT_TRUE(rc::check("by the definition", [] {
        Raster<float> const dem = any_land();
        flow::FlowField const drainage = flow::route(dem);
        auto const support = *rc::gen::inRange<std::int64_t>(1, 9);
        auto const rivers = flow::cells_with_area(drainage, support);
        Raster<double> const length = flow::lengths_to_outlet(drainage);
        Raster<float> const height = flow::heights_above_rivers(dem, rivers, drainage);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (std::isnan(dem[i])) {
                RC_ASSERT(std::isnan(length[i]) && std::isnan(height[i]));
                continue;
            }
            double way = 0.0;
            std::int64_t river = -1;
            for (std::int64_t at = i; at >= 0; at = drainage.receiver(at)) {
                river = river < 0 && drainage.area_cells[at] >= support ? at : river;
                if (drainage.receiver(at) >= 0) {
                    way += dem.grid().cell_m * (is_diagonal(drainage.direction[at]) ? std::sqrt(2.0) : 1.0);
                }
            }
            RC_ASSERT(std::fabs(length[i] - way) < 1e-9 * (1.0 + way));
            RC_ASSERT((river < 0 ? std::isnan(height[i]) : height[i] == dem[i] - dem[river]));
        }
    }));
}

TEST(Paths, OrdersAreStrahlersAndShreves) {
    ASSERT_TRUE(rc::check("by the definition", [] {
        Raster<float> const dem = any_land();
        flow::FlowField const drainage = flow::route(dem);
        auto const support = *rc::gen::inRange<std::int64_t>(1, 5);
        flow::StreamOrders const orders = flow::stream_orders(drainage, support);
        struct Of {
            int strahler = 0;
            std::int64_t shreve = 0;
        };
        std::function<Of(std::int64_t)> const order = [&](std::int64_t i) {
            if (drainage.area_cells[i] < support) {
                return Of();
            }
            Of of;
            int equals = 0;
            for (std::int64_t from = 0; from < dem.cells(); ++from) {
                if (drainage.receiver(from) == i) {
                    Of const in = order(from);
                    equals = in.strahler > of.strahler ? 1 : equals + (in.strahler == of.strahler ? 1 : 0);
                    of = {std::max(of.strahler, in.strahler), of.shreve + in.shreve};
                }
            }
            return of.strahler == 0 ? Of{1, 1} : Of{of.strahler + (equals > 1 ? 1 : 0), of.shreve};
        };
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Of const of = order(i);
            RC_ASSERT(orders.strahler[i] == of.strahler && orders.shreve[i] == of.shreve);
        }
    }));
    EXPECT_THROW(flow::stream_orders(flow::route(Raster<float>(test::frame(2, 2))), 0), BadParameter);
    EXPECT_THROW(flow::cells_with_area(flow::route(Raster<float>(test::frame(2, 2))), 0), BadParameter);
    EXPECT_THROW(
        flow::heights_above_rivers(Raster<float>(test::frame(3, 2)), {}, flow::route(Raster<float>(test::frame(2, 2)))),
        BadInput);
}

TEST(Paths, WaterFollowedInBandsAgreesWithOneThread) {
    ASSERT_TRUE(rc::check("on narrow lands, where water goes back and forth between bands", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        Grid const grid = test::frame(*rc::gen::inRange<std::int64_t>(1, 25), *rc::gen::inRange<std::int64_t>(1, 700));
        auto const hole_in = *rc::gen::element<std::uint64_t>(5, 50, 1000);
        Raster<float> dem(grid);
        std::vector<flow::RiverCell> rivers;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            std::uint64_t const word = random_word(seed, static_cast<std::uint64_t>(i));
            dem[i] = word % hole_in == 0 ? std::nanf("") : static_cast<float>(word % 100);
            if (word % 41 == 0) {
                rivers.push_back({i, rivers.size()});
            }
        }
        thalweg::Run const one = test::on_threads(1);
        thalweg::Run const many = test::on_threads(4);
        flow::FlowField const drainage = flow::route(dem, one);
        auto const same = [](auto const& a, auto const& b) { RC_ASSERT(std::ranges::equal(a.values(), b.values())); };
        same(flow::route(dem, many).area_cells, drainage.area_cells);
        Raster<float> const lengths = flow::flow_lengths(drainage, one);
        same(flow::flow_lengths(drainage, many), lengths);
        std::vector<std::int64_t> some;
        for (flow::RiverCell const& river : rivers) {
            some.push_back(river.cell);
        }
        std::vector<float> const to_some = flow::flow_lengths_to(some, drainage, many);
        for (std::size_t i = 0; i < some.size(); ++i) {
            RC_ASSERT(to_some[i] == lengths[some[i]]);
        }
        flow::StreamOrders const a = flow::stream_orders(drainage, 9, many);
        flow::StreamOrders const b = flow::stream_orders(drainage, 9, one);
        same(a.strahler, b.strahler);
        same(a.shreve, b.shreve);
        same(flow::first_met(rivers, drainage, many), flow::first_met(rivers, drainage, one));
    }));
}

} // namespace paths_test
