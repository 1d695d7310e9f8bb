// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/catchments.hpp>

#include <cmath>
#include <map>
#include <numeric>

#include <gtest/gtest.h>
#include <measure/dems.hpp>
#include <measure/trees.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>

namespace catchments_test {

using namespace thalweg;
using flow::Catchments;
using flow::catchments;
using flow::FlowField;
using flow::Reach;
using flow::reaches_of;
using flow::route;

namespace {

using Counts = std::vector<std::int64_t>;
using test::message_of;

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

/// Rivers on lattices finer or coarser than the cells, and any land with holes under them.
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
    EXPECT_NE(complaint_of(reaches, drainage).find("arc 11 leads to no outlet"), std::string::npos);
    reaches[2].ds = 7;
    EXPECT_NE(complaint_of(reaches, drainage).find("arc 13 runs into reach 7 of 3"), std::string::npos);
    reaches = small_rivers();
    reaches[1].lines[0][0].x = -0.5;
    EXPECT_NE(complaint_of(reaches, drainage).find("of arc 12 at (-0.500, 2.500) lies outside"), std::string::npos);
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

TEST(Catchments, WaterThatMeetsNoRiverBelongsToNone) {
    Raster<float> dem = small_valley();
    dem[Cell{4, 0}] = 1.0F; // a hole in the border takes its neighbours
    dem[Cell{0, 4}] = hole;
    Catchments const c = catchments(small_rivers(), route(dem));
    EXPECT_EQ((c.reach[Cell{4, 0}]), -1);
    EXPECT_EQ((c.reach[Cell{3, 0}]), -1);
    EXPECT_EQ((c.reach[Cell{0, 4}]), -1);
    EXPECT_EQ(c.without + std::accumulate(c.cells.begin(), c.cells.end(), std::int64_t{0}), 24);
    EXPECT_GE(c.without, 2);
}

TEST(Catchments, FollowTheDefinitionAndAgreeWithAreas) {
    ASSERT_TRUE(rc::check("each cell belongs to the owner of the first river cell below it; areas agree", [] {
        auto const [rivers, dem] = *gen_rivers_and_land();
        Grid const& grid = dem.grid();
        FlowField const drainage = route(dem);
        auto const reaches = reaches_of(rivers.plan);
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
        auto const areas = flow::areas_d8(rivers.plan, drainage);
        for (std::size_t a = 0; a < reaches.size(); ++a) {
            RC_ASSERT(areas.ds_area_m2[a] == static_cast<double>(c.upstream[a]) * grid.cell_m * grid.cell_m);
        }
    }));
}

} // namespace catchments_test
