// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/variety.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace variety_test {

using namespace thalweg;
using measure::Variety;
using measure::variety;
using measure::VarietyParams;

namespace {

constexpr double deg = 3.14159265358979323846 / 180.0;

Grid grid_of(std::int64_t width, std::int64_t height, double cell_m) {
    return {width, height, cell_m, 0.0, static_cast<double>(height) * cell_m, ""};
}

Variety of(Raster<float> const& dem, std::vector<std::int64_t> const& rivers = {}, VarietyParams const& params = {}) {
    return variety(dem, flow::route(dem), rivers, params);
}

/// Two planes that fall to the south, the western half gently, the eastern steeply.
Raster<float> two_planes(double west_deg, double east_deg) {
    return test::raster_of(grid_of(400, 200, 30.0), [&](Cell c) {
        double const south_m = 30.0 * static_cast<double>(200 - c.row);
        return 1000.0 + south_m * std::tan((c.col < 200 ? west_deg : east_deg) * deg);
    });
}

/// A valley from north to south, two sides at 45 degrees times rise, with a trench one cell wide below its bottom.
Raster<float> trench(double depth_m) {
    return test::raster_of(grid_of(101, 80, 10.0), [&](Cell c) {
        auto const across = static_cast<double>(std::abs(c.col - 50));
        double const along = 0.02 * 10.0 * static_cast<double>(80 - c.row);
        return 100.0 + along + (c.col == 50 ? -depth_m : 2.0 * across);
    });
}

std::vector<std::int64_t> column(Grid const& grid, std::int64_t col) {
    std::vector<std::int64_t> cells;
    for (std::int64_t r = 0; r < grid.height; ++r) {
        cells.push_back(grid.index({col, r}));
    }
    return cells;
}

/// Land that falls to the west and to the east of a divide at column 150: to rivers on the western side only. The
/// eastern face falls by this tangent for 900 m, then as gently as the rest.
Raster<float> walled(double tangent) {
    return test::raster_of(grid_of(500, 150, 30.0), [&](Cell c) {
        double const x = 30.0 * static_cast<double>(c.col - 150);
        double const face = std::min(x, 900.0) * tangent + std::max(x - 900.0, 0.0) * 0.2;
        double const ripple = 5.0 * static_cast<double>((c.row * 7 + c.col * 3) % 5) / 5.0;
        return 4000.0 + (x < 0.0 ? 0.2 * x : -face) + ripple;
    });
}

/// The place of a share among numbers counted by whole metres.
double percentile_of(std::vector<double> drops, double share) {
    for (double& drop : drops) {
        drop = std::floor(drop);
    }
    std::ranges::sort(drops);
    double const wanted = share * static_cast<double>(drops.size());
    for (std::size_t before = 0; before < drops.size();) {
        auto const here = static_cast<std::size_t>(std::ranges::count(drops, drops[before]));
        if (static_cast<double>(before + here) >= wanted) {
            return drops[before] + (wanted - static_cast<double>(before)) / static_cast<double>(here);
        }
        before += here;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

/// What rivers divide, cell by cell from the definitions.
struct Divided {
    Raster<float> const& dem;
    flow::FlowField const& drainage;
    std::vector<std::int64_t> const& rivers;

    bool drains_in(std::int64_t cell) const {
        for (; cell >= 0; cell = drainage.receiver(cell)) {
            if (std::ranges::find(rivers, cell) != rivers.end()) {
                return true;
            }
        }
        return false;
    }
    double drop(Cell at, double radius) const {
        auto const here = static_cast<double>(dem[at]);
        double most = 0.0;
        for (int k = 0; k < 16; ++k) {
            Cell const there{at.col + std::llround(radius * std::cos(22.5 * k * deg)),
                             at.row + std::llround(radius * std::sin(22.5 * k * deg))};
            bool const counts = dem.grid().contains(there) && !std::isnan(dem[there]);
            most = counts ? std::max(most, here - static_cast<double>(dem[there])) : most;
        }
        return most;
    }
    Variety measured(VarietyParams const& params) const {
        Grid const& grid = dem.grid();
        std::vector<std::int64_t> land;
        std::vector<bool> in(static_cast<std::size_t>(dem.cells()));
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (!std::isnan(dem[i])) {
                land.push_back(i);
                in[i] = drains_in(i);
            }
        }
        auto const squared = [&](std::int64_t a, std::int64_t b) {
            Vec2 const apart{static_cast<double>(grid.at(a).col - grid.at(b).col),
                             static_cast<double>(grid.at(a).row - grid.at(b).row)};
            return dot(apart, apart);
        };
        auto const is_divide = [&](std::int64_t i) {
            return std::ranges::any_of(land, [&](std::int64_t k) { return in[k] != in[i] && squared(i, k) <= 2.0; });
        };
        double const radius = params.wall_m / grid.cell_m;
        double const far = params.divide_m / grid.cell_m;
        std::vector<std::int64_t> divide;
        std::ranges::copy_if(land, std::back_inserter(divide), is_divide);
        std::vector<double> along;
        std::vector<double> everywhere;
        std::vector<double> elsewhere;
        for (std::int64_t const i : divide) {
            along.push_back(drop(grid.at(i), radius));
        }
        for (std::int64_t const i : land) { // cells are as far apart as a tenth of the distance
            everywhere.push_back(drop(grid.at(i), radius));
            if (std::ranges::none_of(divide, [&](std::int64_t k) { return squared(i, k) <= far * far; })) {
                elsewhere.push_back(everywhere.back());
            }
        }
        Variety found;
        found.outside_share = static_cast<double>(std::ranges::count_if(land, [&](auto i) { return !in[i]; })) /
                              static_cast<double>(land.size());
        found.steepest_drop = percentile_of(everywhere, 0.999) / percentile_of(everywhere, 0.9);
        found.wall = percentile_of(along, 0.99) / percentile_of(elsewhere, 0.99);
        return found;
    }
};

} // namespace

// The spread of windows is that of the halves; one plane has none.
TEST(Variety, WindowsDiffer) {
    Variety const one = of(two_planes(20.0, 20.0));
    EXPECT_EQ(one.windows, 8); // of 100 cells
    EXPECT_NEAR(one.slope_spread_deg, 0.0, 0.01);
    Variety const two = of(two_planes(10.0, 30.0));
    EXPECT_NEAR(two.slope_spread_deg, 10.0, 0.5); // a window's edge lies along the step between them
    EXPECT_TRUE(std::isnan(of(two_planes(10.0, 30.0), {}, {.window_m = 6000.0}).slope_spread_deg));
}

TEST(Variety, GentleLandAwayFromRivers) {
    Raster<float> const dem = two_planes(2.0, 30.0);
    Variety const found = of(dem, column(dem.grid(), 20), {.away_m = 300.0});
    EXPECT_NEAR(found.gentle_share, 0.5, 0.01);
    EXPECT_NEAR(found.gentle_away_share, 0.5 - 21.0 / 400.0, 0.01); // ten cells on either side are near
    EXPECT_NEAR(of(dem, column(dem.grid(), 20), {.away_m = 0.0}).gentle_away_share, 0.5 - 1.0 / 400.0, 0.01);
}

// Cells near rivers, counted along rows, are those that a search of all rivers finds.
TEST(Variety, NearIsNear) {
    ASSERT_TRUE(rc::check("cells farther from all rivers", [] {
        Raster<float> const dem = test::raster_of(grid_of(40, 30, 10.0), [](Cell) { return 5.0; });
        auto const rivers = *rc::gen::nonEmpty(
            rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, dem.cells())));
        auto const away_m = static_cast<double>(*rc::gen::inRange(0, 150));
        std::int64_t far = 0;
        for (std::int64_t r = 1; r < 29; ++r) {
            for (std::int64_t c = 1; c < 39; ++c) {
                far += std::none_of(rivers.begin(), rivers.end(),
                                    [&](std::int64_t river) {
                                        Cell const at = dem.grid().at(river);
                                        auto const squared = static_cast<double>((at.col - c) * (at.col - c) +
                                                                                 (at.row - r) * (at.row - r));
                                        return 100.0 * squared <= away_m * away_m;
                                    })
                           ? 1
                           : 0;
            }
        }
        double const share = of(dem, rivers, {.away_m = away_m}).gentle_away_share;
        RC_ASSERT(std::llround(share * 28.0 * 38.0) == far);
    }));
}

// Profiles: a slope that halves half-way up the stem has two thirds of its height there.
TEST(Variety, HeightHalfWay) {
    auto const valley = [](double lower, double upper) {
        return test::raster_of(grid_of(61, 201, 30.0), [&](Cell c) {
            auto const up = static_cast<double>(200 - c.row);
            double const along = std::min(up, 100.0) * lower + std::max(up - 100.0, 0.0) * upper;
            return 30.0 * (along + 0.5 * static_cast<double>(std::abs(c.col - 30)));
        });
    };
    VarietyParams const all_up = {.stream_m2 = 900.0 * 40.0};
    EXPECT_NEAR(of(valley(0.05, 0.05), {}, all_up).half_way_height, 0.5, 0.01);
    EXPECT_NEAR(of(valley(0.10, 0.05), {}, all_up).half_way_height, 2.0 / 3.0, 0.01);
    EXPECT_EQ(of(valley(0.05, 0.05), {}, all_up).stems, 1);
    EXPECT_TRUE(std::isnan(of(valley(0.05, 0.05), {}, {.stream_m2 = 1e9}).half_way_height));
}

TEST(Variety, CanalsAreTrenches) {
    Raster<float> const deep = trench(30.0);
    Variety const found = of(deep, column(deep.grid(), 50));
    EXPECT_EQ(found.river_cells, 80);
    EXPECT_EQ(found.canal_cells, 80);
    EXPECT_EQ(found.canal_share(), 1.0);
    EXPECT_EQ(of(trench(5.0), column(deep.grid(), 50)).canal_cells, 0);
    EXPECT_EQ(of(deep, column(deep.grid(), 51)).canal_cells, 0); // the trench beside it is lower
    Raster<float> one_bank = deep;
    for (std::int64_t r = 0; r < 80; ++r) {
        one_bank[Cell{49, r}] = one_bank[Cell{50, r}] + 1.0F;
    }
    EXPECT_EQ(of(one_bank, column(deep.grid(), 50)).canal_cells, 0); // the lower bank decides
}

TEST(Variety, WallsBesideTheDivide) {
    Raster<float> const gentle = walled(0.2);
    std::vector<std::int64_t> const river = column(gentle.grid(), 2);
    Variety const even = of(gentle, river);
    EXPECT_GT(even.outside_share, 0.5);
    EXPECT_NEAR(even.wall, 1.0, 0.05);
    EXPECT_LT(even.steepest_drop, 1.1);
    Variety const steep = of(walled(1.2), river);
    EXPECT_GT(steep.wall, 4.0);
    EXPECT_GT(steep.steepest_drop, 3.0);
    EXPECT_TRUE(std::isnan(of(walled(1.2)).wall)); // no rivers are given
    EXPECT_EQ(of(walled(1.2)).steepest_drop, steep.steepest_drop);
}

// What drains to a given river and what past it: all land of a valley drains to the river at its bottom.
TEST(Variety, LandThatDrainsPastTheRivers) {
    Raster<float> const dem = trench(1.0);
    EXPECT_EQ(of(dem, column(dem.grid(), 50)).outside_share, 0.0);
    EXPECT_NEAR(of(dem, {dem.grid().index({50, 0})}).outside_share, 1.0, 0.03);
}

TEST(Variety, DivideAndDropsAsDefined) {
    ASSERT_TRUE(rc::check("the same of every cell", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        Raster<float> dem = test::raster_of(grid_of(44, 41, 100.0), [&](Cell c) {
            double const noise = unit(random_word(seed, static_cast<std::uint64_t>(44 * c.row + c.col)));
            return 500.0 + 20.0 * static_cast<double>(c.row) + 15.0 * std::abs(static_cast<double>(c.col - 15)) +
                   100.0 * noise;
        });
        for (std::int64_t const hole :
             *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, dem.cells()))) {
            dem[hole] = std::numeric_limits<float>::quiet_NaN();
        }
        flow::FlowField const drainage = flow::route(dem);
        std::vector<std::int64_t> rivers;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (!std::isnan(dem[i]) && dem.grid().at(i).row < 30 && drainage.area_cells[i] > 60) {
                rivers.push_back(i);
            }
        }
        RC_PRE(!rivers.empty());
        VarietyParams const params{.wall_m = 1000.0, .divide_m = 500.0, .least_share = 0.0};
        Variety const found = variety(dem, drainage, rivers, params);
        Variety const slow = Divided{dem, drainage, rivers}.measured(params);
        RC_CLASSIFY(!std::isnan(found.wall), "has a wall");
        RC_ASSERT(found.outside_share == slow.outside_share);
        RC_ASSERT(found.steepest_drop == slow.steepest_drop);
        RC_ASSERT(found.wall == slow.wall ||
                  (std::isnan(found.wall) && !(slow.wall >= 0.0 && std::isfinite(slow.wall))));
    }));
}

// The values that natural ranges are made of; tests/clients/check_relief.py measures them by numpy.
TEST(Variety, OfRealLand) {
    Raster<float> const dem = io::read_dem(std::string(THALWEG_SOURCE_DIR "/samples/bigtujunga_srtm1_utm11.tif"));
    flow::FlowField const drainage = flow::route(dem);
    Variety const found = variety(dem, drainage);
    EXPECT_NEAR(found.slope_spread_deg, 4.2, 0.05);
    EXPECT_NEAR(found.gentle_share, 0.027, 0.005);
    EXPECT_EQ(found.canal_cells, 0);
    Variety const by_others = variety(dem, drainage, VarietyParams{}, test::on_threads(3));
    EXPECT_EQ(found.slope_spread_deg, by_others.slope_spread_deg);
    EXPECT_EQ(found.gentle_away_share, by_others.gentle_away_share);
    EXPECT_EQ(found.steepest_drop, by_others.steepest_drop);
}

TEST(Variety, MissingCellsAndSmallDems) {
    Variety const none = of(test::raster_of(grid_of(3, 3, 30.0), [](Cell) { return 1.0; }));
    EXPECT_TRUE(std::isnan(none.slope_spread_deg));
    EXPECT_TRUE(std::isnan(none.half_way_height));
    EXPECT_TRUE(std::isnan(none.steepest_drop));
    EXPECT_TRUE(std::isnan(none.canal_share()));
    Raster<float> holed = two_planes(10.0, 30.0);
    for (std::int64_t r = 0; r < 200; ++r) {
        for (std::int64_t c = 300; c < 400; ++c) {
            holed[Cell{c, r}] = std::numeric_limits<float>::quiet_NaN();
        }
    }
    EXPECT_EQ(of(holed, column(holed.grid(), 350)).river_cells, 0);
    EXPECT_EQ(of(holed).windows, 6);
}

TEST(Variety, Refusals) {
    Raster<float> const dem = trench(1.0);
    EXPECT_THROW(of(dem, {dem.cells()}), BadInput);
    EXPECT_THROW(of(dem, {}, {.window_m = 0.0}), BadParameter);
    EXPECT_THROW(variety(dem, flow::route(two_planes(1.0, 2.0))), BadInput);
}

} // namespace variety_test
