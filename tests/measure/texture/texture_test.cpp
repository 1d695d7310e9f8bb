// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/texture/texture.hpp>

#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>

#include "dems.hpp"

namespace texture_test {

using namespace thalweg;
using flow::route;
using measure::gradient_texture;
using measure::GradientTexture;
using measure::straight_channels;
using measure::StraightChannels;
using measure::texture_lags_m;

namespace {

using test::on_threads;

Grid cells_of(double cell_m, std::int64_t width, std::int64_t height) {
    Grid grid = frame(width, height);
    grid.cell_m = cell_m;
    return grid;
}

template <class Height> Raster<float> dem_by(Grid const& grid, Height height) {
    return test::raster_of(grid, height);
}

/// d z by central differences, at the edges to one side.
double slope_along(Raster<float> const& dem, Cell at, Cell step) {
    Cell const before{at.col - step.col, at.row - step.row};
    Cell const after{at.col + step.col, at.row + step.row};
    bool const first = !dem.grid().contains(before);
    bool const last = !dem.grid().contains(after);
    double const rise = static_cast<double>(dem[last ? at : after]) - static_cast<double>(dem[first ? at : before]);
    return first || last ? rise : 0.5 * rise;
}

struct Unit {
    double x;
    double y;
};

Unit unit_at(Raster<float> const& dem, Cell at) {
    double const x = slope_along(dem, at, {1, 0});
    double const y = slope_along(dem, at, {0, 1});
    double const length = std::sqrt(x * x + y * y);
    return length > 0.0 ? Unit{x / length, y / length} : Unit{0.0, 0.0};
}

double mean_product(Raster<float> const& dem, Cell lag) {
    double sum = 0.0;
    int pairs = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const at = dem.grid().at(i);
        Cell const there{at.col + lag.col, at.row + lag.row};
        if (!dem.grid().contains(there)) {
            continue;
        }
        Unit const a = unit_at(dem, at);
        Unit const b = unit_at(dem, there);
        if (a.x * a.x + a.y * a.y > 0.5 && b.x * b.x + b.y * b.y > 0.5) {
            sum += a.x * b.x + a.y * b.y;
            ++pairs;
        }
    }
    return sum / pairs;
}

/// The structure tensor in a Gaussian window round every cell, without blocks.
double anisotropy_cell_by_cell(Raster<float> const& dem, double window) {
    double sum = 0.0;
    int cells = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const at = dem.grid().at(i);
        auto const near = [&](std::int64_t place, std::int64_t count) {
            double const centre = static_cast<double>(place) + 0.5;
            return centre < 2.0 * window || centre > static_cast<double>(count) - 2.0 * window;
        };
        if (near(at.col, dem.width()) || near(at.row, dem.height())) {
            continue;
        }
        double xx = 0.0;
        double yy = 0.0;
        double xy = 0.0;
        for (std::int64_t k = 0; k < dem.cells(); ++k) {
            Cell const there = dem.grid().at(k);
            auto const far = static_cast<double>((there.col - at.col) * (there.col - at.col) +
                                                 (there.row - at.row) * (there.row - at.row));
            double const weight = std::exp(-0.5 * far / (window * window));
            Unit const u = unit_at(dem, there);
            xx += weight * u.x * u.x;
            yy += weight * u.y * u.y;
            xy += weight * u.x * u.y;
        }
        sum += std::sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy) / (xx + yy);
        ++cells;
    }
    return sum / cells;
}

/// A valley along the middle row of a plane that falls to the east.
Raster<float> valley(std::int64_t width) {
    return test::raster_of(frame(width, 9), [&](Cell at) {
        return static_cast<float>(width - at.col) + 4.0F * std::fabs(static_cast<float>(at.row - 4));
    });
}

} // namespace

TEST(GradientTexture, RefusesNonsense) {
    Raster<float> const dem = rough_dem(frame(9, 9), 1);
    EXPECT_THROW(gradient_texture(dem, {.window_m = 0.0}), BadParameter);
    EXPECT_THROW(gradient_texture(dem, {.window_m = std::nan("")}), BadParameter);
    EXPECT_THROW(gradient_texture(rough_dem(cells_of(0.0, 9, 9), 1)), BadInput);
}

TEST(GradientTexture, OfLittleLandIsUnknown) {
    for (Raster<float> const& dem :
         {Raster<float>{}, dem_of(1, {1.0F}), rough_dem(cells_of(30.0, 11, 200), 1),
          rough_dem(cells_of(5000.0, 90, 90), 1), Raster<float>(cells_of(30.0, 300, 300), 1.0F),
          Raster<float>(cells_of(30.0, 300, 300), hole)}) {
        GradientTexture const found = gradient_texture(dem);
        EXPECT_TRUE(std::isnan(found.correlation[2]));
        EXPECT_TRUE(std::isnan(found.anisotropy));
    }
}

// A plane looks one way everywhere.
TEST(GradientTexture, OfAPlaneIsWhole) {
    GradientTexture const found = gradient_texture(dem_by(cells_of(30.0, 200, 180), [](Cell at) {
        return 2.0 * static_cast<double>(at.col) - static_cast<double>(at.row);
    }));
    for (double const correlation : found.correlation) {
        EXPECT_NEAR(correlation, 1.0, 1e-6);
    }
    EXPECT_NEAR(found.anisotropy, 1.0, 1e-6);
}

// Parallel ridges whose wave is twice the lag: what looks east here looks west there.
TEST(GradientTexture, OfParallelRidges) {
    GradientTexture const found = gradient_texture(dem_by(cells_of(30.0, 200, 180), [](Cell at) {
        return 100.0 * std::sin(2.0 * 3.14159265358979 * (static_cast<double>(at.col) + 0.3) / 24.0);
    }));
    EXPECT_NEAR(found.correlation[0], 0.0, 0.02); // along the ridges 1, across -1
    EXPECT_NEAR(found.correlation[1], 1.0, 0.02);
    EXPECT_NEAR(found.anisotropy, 1.0, 1e-6);
}

TEST(GradientTexture, OfNoiseIsNone) {
    GradientTexture const found = gradient_texture(rough_dem(cells_of(30.0, 400, 400), 7));
    for (double const correlation : found.correlation) {
        EXPECT_NEAR(correlation, 0.0, 0.01);
    }
    EXPECT_LT(found.anisotropy, 0.05);
}

TEST(GradientTexture, AsMeasuredCellByCell) {
    ASSERT_TRUE(rc::check("as the definition says; blocks change the anisotropy by less than 0.005", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        Raster<float> const noise = rough_dem(cells_of(90.0, 44, 52), seed);
        Raster<float> const dem = dem_by(noise.grid(), [&](Cell at) {
            return static_cast<double>(noise[at]) + std::sin(0.4 * static_cast<double>(at.col + at.row));
        });
        GradientTexture const found = gradient_texture(dem, {.window_m = 630.0});
        RC_ASSERT(std::fabs(found.correlation[0] - 0.5 * (mean_product(dem, {4, 0}) + mean_product(dem, {0, 4}))) <
                  1e-5);
        RC_ASSERT(std::fabs(found.correlation[1] - 0.5 * (mean_product(dem, {8, 0}) + mean_product(dem, {0, 8}))) <
                  1e-5);
        RC_ASSERT(std::fabs(found.anisotropy - anisotropy_cell_by_cell(dem, 7.0)) < 0.005);
    }));
}

TEST(GradientTexture, HolesAreLeftOut) {
    Raster<float> dem = dem_by(cells_of(30.0, 300, 300), [](Cell at) { return static_cast<double>(at.col); });
    for (std::int64_t c = 0; c < 300; ++c) {
        dem[Cell{c, 150}] = hole;
    }
    GradientTexture const found = gradient_texture(dem);
    EXPECT_NEAR(found.correlation[0], 1.0, 1e-6);
    EXPECT_TRUE(std::isnan(found.anisotropy) || found.anisotropy > 0.999);
}

TEST(GradientTexture, SameBitsForAnyThreads) {
    Raster<float> const dem = rough_dem(cells_of(30.0, 310, 290), 3);
    thalweg::Run const one = on_threads(1);
    thalweg::Run const five = on_threads(5);
    GradientTexture const a = gradient_texture(dem, {}, one);
    GradientTexture const b = gradient_texture(dem, {}, five);
    EXPECT_EQ(a.correlation, b.correlation);
    EXPECT_EQ(a.anisotropy, b.anisotropy);
}

TEST(StraightChannels, RefusesNonsense) {
    flow::FlowField const drainage = route(rough_dem(frame(9, 9), 1));
    EXPECT_THROW(straight_channels(drainage, {.support_cells = 0}), BadParameter);
    EXPECT_THROW(straight_channels(drainage, {.reach_steps = 1}), BadParameter);
    EXPECT_THROW(straight_channels(drainage, {.tolerance_cells = -1.0}), BadParameter);
    EXPECT_THROW(straight_channels(drainage, {.tolerance_cells = std::nan("")}), BadParameter);
}

TEST(StraightChannels, NoneWithoutChannels) {
    StraightChannels const found = straight_channels(route(rough_dem(frame(9, 9), 1)));
    EXPECT_EQ(found.longest_run, 0);
    EXPECT_EQ(found.reaches, 0);
    EXPECT_TRUE(std::isnan(found.straight_share));
}

TEST(StraightChannels, AStraightValleyIs) {
    StraightChannels const found = straight_channels(route(valley(100)), {.support_cells = 20, .reach_steps = 10});
    EXPECT_GE(found.longest_run, 95);
    EXPECT_EQ(found.straight_share, 1.0);
    EXPECT_GE(found.reaches, 85);
}

TEST(StraightChannels, LevelWaterIsNoChannel) {
    Raster<float> dem = valley(200); // its channel is row 4
    for (std::int64_t col = 80; col < 140; ++col) {
        for (std::int64_t row = 1; row < dem.height() - 1; ++row) {
            dem[Cell{col, row}] = dem[Cell{140, 4}];
        }
    }
    flow::FlowField const drainage = route(dem);
    measure::StraightChannelsParams const params{.support_cells = 20, .reach_steps = 10};
    StraightChannels const all = straight_channels(drainage, params);
    StraightChannels const land = straight_channels(drainage, dem, params);
    EXPECT_GE(all.longest_run, 60);
    EXPECT_LE(land.longest_run, 82) << "to the lake";
    EXPECT_LT(land.reaches, all.reaches - 20) << "none where the water crosses the lake";
    EXPECT_EQ(straight_channels(drainage, valley(200), params).longest_run, all.longest_run) << "no water is level";
}

TEST(StraightChannels, RefusesAnotherGrid) {
    flow::FlowField const drainage = route(rough_dem(frame(9, 9), 1));
    EXPECT_THROW(straight_channels(drainage, rough_dem(frame(9, 8), 1)), BadInput);
}

TEST(StraightChannels, AsCountedDownstream) {
    ASSERT_TRUE(rc::check("runs by area from the sources down, reaches by their chord", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        Raster<float> dem = rough_dem(frame(40, 50), seed);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Cell const at = dem.grid().at(i);
            bool const in_lake = at.row >= 15 && at.row < 32 && at.col >= 10 && at.col < 35;
            dem[i] = in_lake ? dem[dem.grid().index({10, 15})] : dem[i] + 0.1F * static_cast<float>(at.row);
        }
        flow::FlowField const drainage = route(dem);
        bool const knows_water = *rc::gen::arbitrary<bool>();
        auto const is_water = [&](std::int64_t cell) {
            bool level = knows_water;
            for (Cell const step : d8_steps) {
                Cell const beside{dem.grid().at(cell).col + step.col, dem.grid().at(cell).row + step.row};
                level = level && dem.grid().contains(beside) && dem[beside] == dem[cell];
            }
            return level;
        };
        std::multimap<std::int64_t, std::int64_t> by_area;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (drainage.area_cells[i] >= 15 && drainage.receiver(i) >= 0 && !is_water(i)) {
                by_area.emplace(drainage.area_cells[i], i);
            }
        }
        std::map<std::int64_t, std::int64_t> run_to; // steps in the cell's own direction, itself included
        std::int64_t longest = 0;
        std::int64_t reaches = 0;
        std::int64_t straight = 0;
        for (auto const& [area, cell] : by_area) {
            std::int64_t const steps = ++run_to[cell];
            longest = std::max(longest, steps);
            std::int64_t const below = drainage.receiver(cell);
            if (drainage.direction[below] == drainage.direction[cell] && !is_water(below)) {
                run_to[below] = std::max(run_to[below], steps);
            }
            std::vector<Cell> reach{dem.grid().at(cell)};
            for (std::int64_t at = drainage.receiver(cell); at >= 0 && reach.size() < 9 && !is_water(at);
                 at = drainage.receiver(at)) {
                reach.push_back(dem.grid().at(at));
            }
            if (reach.size() < 9) {
                continue;
            }
            ++reaches;
            auto const dx = static_cast<double>(reach.back().col - reach.front().col);
            auto const dy = static_cast<double>(reach.back().row - reach.front().row);
            double const chord = std::sqrt(dx * dx + dy * dy);
            bool near = chord >= 1.0;
            for (Cell const at : reach) {
                double const across = std::fabs(static_cast<double>(at.row - reach.front().row) * dx -
                                                static_cast<double>(at.col - reach.front().col) * dy);
                near = near && across <= 1.0 * chord;
            }
            straight += near ? 1 : 0;
        }
        measure::StraightChannelsParams const params{.support_cells = 15, .reach_steps = 8, .tolerance_cells = 1.0};
        StraightChannels const found =
            knows_water ? straight_channels(drainage, dem, params) : straight_channels(drainage, params);
        RC_ASSERT(found.longest_run == longest);
        RC_ASSERT(found.reaches == reaches);
        RC_ASSERT(reaches == 0 || found.straight_share == static_cast<double>(straight) / static_cast<double>(reaches));
    }));
}

} // namespace texture_test
