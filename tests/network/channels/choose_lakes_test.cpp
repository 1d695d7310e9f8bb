// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/lakes.hpp>

#include <algorithm>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

namespace choose_lakes_test {

namespace {

using namespace thalweg;
using network::channels;
using network::ChannelsOfArcs;
using network::choose_lakes;

ChannelsOfArcs one_river() {
    return channels(test::network_of({{50.5, 0.5}, {50.5, 99.5}}, {{1, 0}}), test::frame(100, 100));
}

TEST(ChooseLakes, RefusesBadParameters) {
    EXPECT_THROW(choose_lakes(one_river(), {1.0}, {.share = 1.1}), BadParameter);
    EXPECT_THROW(choose_lakes(one_river(), {1.0}, {.min_area_cells = -1.0}), BadParameter);
    EXPECT_THROW(choose_lakes(one_river(), {1.0}, {.max_cells = 3}), BadParameter);
    EXPECT_THROW(choose_lakes(one_river(), {}), BadInput);
}

TEST(ChooseLakes, NoShareAndNoAreaAreNoLake) {
    auto const count = [](Raster<std::int32_t> const& labels) {
        return std::count_if(labels.values().begin(), labels.values().end(), [](std::int32_t v) { return v != 0; });
    };
    EXPECT_EQ(count(choose_lakes(one_river(), {1e5}, {.share = 0.0})), 0);
    EXPECT_EQ(count(choose_lakes(one_river(), {1999.0}, {.share = 1.0})), 0);
    EXPECT_GE(count(choose_lakes(one_river(), {2000.0}, {.share = 1.0})), 8);
}

TEST(ChooseLakes, AShareOfReaches) {
    ASSERT_TRUE(rc::check("lakes keep apart and from the edge, and can be flooded", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        StreamNetwork const net = test::random_skeleton(seed, 90);
        Grid const grid = test::frame(90, 90);
        ChannelsOfArcs const drawn = channels(net, grid);
        std::vector<double> const areas(drawn.of_arc.size(), 5e4);
        auto const labels =
            choose_lakes(drawn, areas, {.share = *rc::gen::element(0.3, 1.0), .max_cells = 150, .seed = seed});
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (labels[i] == 0) {
                continue;
            }
            Cell const c = grid.at(i);
            RC_ASSERT(c.col >= 3);
            RC_ASSERT(c.row >= 3);
            RC_ASSERT(c.col < 87);
            RC_ASSERT(c.row < 87);
            for (std::int64_t dr = -2; dr <= 2; ++dr) {
                for (std::int64_t dc = -2; dc <= 2; ++dc) {
                    std::int32_t const other = labels[Cell{c.col + dc, c.row + dr}];
                    RC_ASSERT((other == 0 || other == labels[i]));
                }
            }
        }
        network::Flooded const flooded = network::flood_lakes(drawn, labels);
        std::int32_t const chosen = *std::max_element(labels.values().begin(), labels.values().end());
        RC_ASSERT(static_cast<std::int32_t>(flooded.lakes.size()) <= 2 * chosen);
        RC_ASSERT((chosen == 0) == (flooded.lakes.empty()));
        for (network::Lake const& lake : flooded.lakes) {
            RC_ASSERT(lake.cells <= 250);
        }
    }));
}

} // namespace

} // namespace choose_lakes_test
