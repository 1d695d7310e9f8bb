// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/extract_streams.hpp>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <measure/dems.hpp>
#include <rapidcheck.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>

namespace extract_streams_test {

using namespace thalweg;
using flow::extract_streams;
using flow::ExtractedStreams;
using flow::FlowField;
using flow::support_for_length;

namespace {

/// Every step of water between cells through which enough drains.
std::set<std::pair<std::int64_t, std::int64_t>> steps_of(FlowField const& drainage, std::int64_t support) {
    std::set<std::pair<std::int64_t, std::int64_t>> steps;
    Grid const& grid = drainage.area_cells.grid();
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (drainage.area_cells[i] >= support && goes_on(drainage.direction[i])) {
            Cell const step = d8_steps[index_of(drainage.direction[i])];
            steps.insert({i, grid.index({grid.at(i).col + step.col, grid.at(i).row + step.row})});
        }
    }
    return steps;
}

double length_of_steps(Grid const& grid, std::set<std::pair<std::int64_t, std::int64_t>> const& steps) {
    double length = 0.0;
    for (auto const& [from, to] : steps) {
        length += distance(grid.centre(grid.at(from)), grid.centre(grid.at(to)));
    }
    return length;
}

} // namespace

TEST(ExtractStreams, RefusesWhatDoesNotBelongTogether) {
    Raster<float> const dem = dem_of(2, {2, 1, 2, 1});
    FlowField const drainage = flow::route(dem);
    EXPECT_THROW(extract_streams(drainage, dem, {.support_cells = 0}), BadParameter);
    EXPECT_THROW(extract_streams(drainage, dem_of(1, {1, 2})), BadInput);
    EXPECT_THROW(support_for_length(drainage, 0.0), BadParameter);
    EXPECT_THROW(support_for_length(drainage, std::numeric_limits<double>::quiet_NaN()), BadParameter);
}

TEST(ExtractStreams, NoDataAndLoneCellsHaveNoRivers) {
    for (Raster<float> const& dem : {Raster<float>(frame(3, 2), hole), dem_of(1, {4})}) {
        FlowField const drainage = flow::route(dem);
        ExtractedStreams const streams = extract_streams(drainage, dem, {.support_cells = 1});
        EXPECT_EQ(streams.network.planform.node_count(), 0U);
        EXPECT_EQ(support_for_length(drainage, 1.0), 1);
    }
}

TEST(ExtractStreams, AFork) {
    // Two valleys meet in the middle and leave in the south.
    Raster<float> const dem = dem_of(5, {
                                            9, 9, 9, 9, 9, //
                                            9, 6, 9, 6, 9, //
                                            9, 9, 4, 9, 9, //
                                            9, 9, 3, 9, 9, //
                                            9, 9, 1, 9, 9, //
                                        });
    FlowField const drainage = flow::route(dem);
    ExtractedStreams const streams = extract_streams(drainage, dem, {.support_cells = 4});
    ASSERT_EQ(streams.network.planform.node_count(), 4U);
    ASSERT_EQ(streams.network.planform.arc_count(), 3U);
    EXPECT_EQ(streams.network.planform.outlets(), std::vector<NodeId>{3});
    EXPECT_EQ(streams.network.planform.arc(2).line.size(), 3U);
    EXPECT_EQ(streams.network.arc_z[2], (std::vector<double>{4, 3, 1}));
    EXPECT_EQ(streams.network.node_z, (std::vector<double>{6, 6, 4, 1}));
}

TEST(ExtractStreams, IsWhatDrainsThroughEnoughCells) {
    ASSERT_TRUE(rc::check("arcs step where water steps, once; areas are those of areas_d8", [] {
        Raster<float> const dem = *gen_dem(14, 20);
        auto const support = *evenly<std::int64_t>(1, 12);
        FlowField const drainage = flow::route(dem);
        ExtractedStreams const streams = extract_streams(drainage, dem, {.support_cells = support});
        StreamNetwork const& plan = streams.network.planform;
        std::set<std::pair<std::int64_t, std::int64_t>> walked;
        double length = 0.0;
        for (std::size_t a = 0; a < plan.arc_count(); ++a) {
            auto const& line = plan.arc(a).line;
            RC_ASSERT(line.size() == streams.network.arc_z[a].size());
            for (std::size_t i = 0; i < line.size(); ++i) {
                RC_ASSERT(static_cast<double>(dem[dem.grid().cell_of(line[i])]) == streams.network.arc_z[a][i]);
                if (i > 0) {
                    bool const first = walked
                                           .insert({dem.grid().index(dem.grid().cell_of(line[i - 1])),
                                                    dem.grid().index(dem.grid().cell_of(line[i]))})
                                           .second;
                    RC_ASSERT(first);
                }
            }
            length += plan.length_m(a);
        }
        auto const steps = steps_of(drainage, support);
        RC_ASSERT(walked == steps);
        for (NodeId n = 0; n < plan.node_count(); ++n) {
            RC_ASSERT(plan.in(n).size() != 1U || plan.out(n) == no_arc); // no node in mid-river
            RC_ASSERT(plan.basin(n) > 0);
        }
        auto const areas = flow::areas_d8(plan, drainage);
        RC_ASSERT(areas.us_area_m2 == streams.areas.us_area_m2);
        RC_ASSERT(areas.ds_area_m2 == streams.areas.ds_area_m2);
        RC_ASSERT(areas.node_m2 == streams.areas.node_m2);

        if (length > 0.0) {
            std::int64_t slow = 1;
            for (std::int64_t s = 1; s <= dem.cells(); ++s) {
                if (length_of_steps(dem.grid(), steps_of(drainage, s)) >= length * (1.0 - 1e-12)) {
                    slow = s;
                }
            }
            RC_ASSERT(support_for_length(drainage, length * (1.0 - 1e-12)) == slow);
        }
    }));
}

} // namespace extract_streams_test
