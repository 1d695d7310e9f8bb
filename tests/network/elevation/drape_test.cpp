// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/known_heights.hpp>

#include <algorithm>
#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <measure/trees.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

namespace drape_test {

using namespace thalweg;

namespace {

Raster<float> land(std::uint64_t seed, std::int64_t cols, std::int64_t rows) {
    Raster<float> dem(Grid{cols, rows, 1.0, 0.0, static_cast<double>(rows), {}});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = static_cast<float>(random_word(seed, 77 + static_cast<std::uint64_t>(i)) % 1000) / 8.0F;
    }
    return dem;
}

} // namespace

TEST(Drape, RefusesWhereTheDemHasNoHeight) {
    ElevatedNetwork const rivers = random_rivers(1, 5, 5);
    Raster<float> dem = land(1, 5, 5);
    EXPECT_NO_THROW(network::drape(rivers.plan, dem));
    dem[Cell{0, 0}] = std::numeric_limits<float>::quiet_NaN(); // sources lie in the northernmost row
    EXPECT_THROW(network::drape(rivers.plan, dem), BadInput);
    EXPECT_THROW(network::drape(rivers.plan, land(1, 5, 3)), BadInput);
}

// Law: each vertex has the least height of the cells at it and upstream of it; so heights never rise downstream.
TEST(Drape, LeastHeightOfAllUpstream) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const cols = *rc::gen::inRange<std::int64_t>(2, 20);
        auto const rows = *rc::gen::inRange<std::int64_t>(2, 20);
        ElevatedNetwork const rivers = random_rivers(seed, cols, rows);
        Raster<float> const dem = land(seed, cols, rows);
        ElevatedNetwork const raised = network::drape(rivers.plan, dem);
        auto const at = [&](Vec2 p) { return static_cast<double>(dem[dem.grid().cell_of(p)]); };
        std::function<double(NodeId)> const least = [&](NodeId n) {
            double z = at(rivers.plan.node(n).at);
            for (ArcId const in : rivers.plan.in(n)) {
                auto const a = in;
                for (Vec2 const p : rivers.plan.arc(a).line) {
                    z = std::min(z, at(p));
                }
                z = std::min(z, least(rivers.plan.from(a)));
            }
            return z;
        };
        for (NodeId n = 0; n < rivers.plan.node_count(); ++n) {
            RC_ASSERT(raised.node_z[n] == least(n));
        }
        for (std::size_t a = 0; a < rivers.plan.arc_count(); ++a) {
            double z = raised.node_z[rivers.plan.from(a)];
            auto const& line = rivers.plan.arc(a).line;
            RC_ASSERT(raised.arc_z[a].size() == line.size());
            for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                z = std::min(z, at(line[i]));
                RC_ASSERT(raised.arc_z[a][i] == z);
            }
            RC_ASSERT(raised.arc_z[a].back() == raised.node_z[rivers.plan.to(a)]);
        }
    }));
}

} // namespace drape_test
