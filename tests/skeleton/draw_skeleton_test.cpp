// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/draw_skeleton.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stop_token>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>

#include "fields.hpp"

namespace draw_skeleton_test {

using namespace thalweg;
using skeleton::draw_skeleton;
using skeleton::DrawnSkeleton;
using skeleton::noise_along;
using skeleton::NoiseAlongParams;
using skeleton::PlaceOnLine;

namespace {

using test::has;
using test::message_of;
using test::same_bits;

constexpr float none = std::numeric_limits<float>::quiet_NaN();

Valley dry(std::int64_t width, std::int64_t height) {
    return {Raster<float>(frame(width, height), none)};
}

RidgeLines one_ridge(std::vector<Vec3> line) {
    return {{{std::move(line), 1, 2}}};
}

/// Rows of whole heights, '.' for none.
std::string picture(Raster<float> const& z) {
    std::string text;
    for (std::int64_t r = 0; r < z.height(); ++r) {
        for (std::int64_t c = 0; c < z.width(); ++c) {
            float const here = z[Cell{c, r}];
            text += std::isnan(here) ? "." : std::to_string(static_cast<int>(here));
        }
        text += "\n";
    }
    return text;
}

struct Scene {
    Valley valley;
    RidgeLines ridges;
    FeaturePoints points;
};

Scene any_scene() {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 14);
    auto const height = *rc::gen::inRange<std::int64_t>(1, 14);
    auto const somewhere = [&] {
        return Vec3{static_cast<double>(*rc::gen::inRange<std::int64_t>(0, 4 * width + 1)) / 4.0,
                    static_cast<double>(*rc::gen::inRange<std::int64_t>(0, 4 * height + 1)) / 4.0,
                    static_cast<double>(*rc::gen::inRange(-9, 99)) / 3.0};
    };
    Scene scene{dry(width, height), {}, {}};
    auto const wet = *rc::gen::inRange(0, 20);
    for (int i = 0; i < wet; ++i) {
        scene.valley.z[*rc::gen::inRange<std::int64_t>(0, width * height)] = static_cast<float>(i) - 0.5F;
    }
    auto const ridges = *rc::gen::inRange(0, 4);
    for (int i = 0; i < ridges; ++i) {
        auto& line = scene.ridges.lines.emplace_back().line;
        auto const vertices = *rc::gen::inRange(1, 6);
        for (int k = 0; k < vertices; ++k) {
            line.push_back(somewhere());
        }
    }
    auto const points = *rc::gen::inRange(0, 8);
    for (int i = 0; i < points; ++i) {
        scene.points.points.push_back(somewhere());
    }
    return scene;
}

Cell cell_in(Grid const& grid, Vec3 const& p) {
    Cell const c = grid.cell_of({p.x, p.y});
    return {std::min(c.col, grid.width - 1), std::min(c.row, grid.height - 1)};
}

/// All heights that ridges without noise have in each cell.
std::map<std::int64_t, std::set<float>> ridge_heights(Scene const& scene) {
    Grid const& grid = scene.valley.z.grid();
    std::map<std::int64_t, std::set<float>> heights;
    for (RidgeLine const& ridge : scene.ridges.lines) {
        auto const& line = ridge.line;
        for (Vec3 const& p : line) {
            heights[grid.index(cell_in(grid, p))].insert(static_cast<float>(p.z));
        }
        for (std::size_t i = 1; i < line.size(); ++i) {
            walk_cells(cell_in(grid, line[i - 1]), cell_in(grid, line[i]), [&](Cell c, std::int64_t k, std::int64_t n) {
                if (k > 0 && k < n) {
                    double const share = static_cast<double>(k) / static_cast<double>(n);
                    heights[grid.index(c)].insert(
                        static_cast<float>(line[i - 1].z + share * (line[i].z - line[i - 1].z)));
                }
            });
        }
    }
    return heights;
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Places in the middle of lines, along a parallel.
std::vector<PlaceOnLine> parallel(int count, double apart_m) {
    std::vector<PlaceOnLine> places;
    for (int i = 0; i < count; ++i) {
        places.push_back({{500000.0 + apart_m * i, 4000000.0}, 0.5});
    }
    return places;
}

/// Mean square of a - b for values so many apart.
double rise(std::vector<double> const& values, std::size_t lag) {
    double sum = 0.0;
    for (std::size_t i = lag; i < values.size(); ++i) {
        sum += (values[i] - values[i - lag]) * (values[i] - values[i - lag]);
    }
    return sum / static_cast<double>(values.size() - lag);
}

} // namespace

TEST(DrawSkeleton, NothingAtAll) {
    EXPECT_EQ(draw_skeleton({}, {}, {}).skeleton.z.cells(), 0);
    DrawnSkeleton const drawn = draw_skeleton(dry(3, 2), {}, {});
    EXPECT_EQ(picture(drawn.skeleton.z), "...\n...\n");
    EXPECT_EQ(drawn.river_cells + drawn.ridge_cells + drawn.point_cells + drawn.under_rivers + drawn.below_river, 0);
}

TEST(DrawSkeleton, RefusesWhatItCannotDraw) {
    Valley const valley = dry(4, 3);
    EXPECT_TRUE(test::has(
        message_of([&] {
            draw_skeleton(
                valley, {{{{{1.0, 1.0, 0.0}, {2.0, 1.0, 0.0}}, 1, 2}, {{{1.0, 1.0, 0.0}, {4.5, 1.0, 0.0}}, 1, 2}}}, {});
        }),
        "vertex 1 of ridge 2 at (4.500, 1.000)"));
    EXPECT_TRUE(test::has(message_of([&] {
                              draw_skeleton(valley, {}, {{{1.0, 1.0, 0.0}, {1.0, -0.5, 0.0}}, ""});
                          }),
                          "point 2 at (1.000, -0.500)"));
    EXPECT_TRUE(test::has(message_of([&] {
                              draw_skeleton(valley, one_ridge({{1.0, 1.0, 0.0}, {2.0, 1.0, NAN}}), {});
                          }),
                          "ridge 1 at (2.000, 1.000)"));
    EXPECT_THROW(draw_skeleton(valley, one_ridge({{NAN, 1.0, 0.0}, {2.0, 1.0, 0.0}}), {}), BadInput);
    EXPECT_THROW(draw_skeleton(valley, one_ridge({}), {}), BadInput);
    EXPECT_THROW(draw_skeleton(valley, {}, {{{1.0, 1.0, 1e300}}, ""}), BadInput);
    EXPECT_THROW(draw_skeleton(valley, {}, {}, {.noise = {.amplitude_m = -1.0}}), BadParameter);
    Valley in_utm = valley;
    Grid grid = valley.z.grid();
    grid.crs = "EPSG:32631";
    in_utm.z = Raster<float>(grid, none);
    EXPECT_NO_THROW(draw_skeleton(in_utm, {}, {{{1.0, 1.0, 0.0}}, "EPSG:32631"}));
    EXPECT_THROW(draw_skeleton(in_utm, {}, {{{1.0, 1.0, 0.0}}, "EPSG:32632"}), BadInput);
    Valley endless = valley;
    endless.z[Cell{2, 1}] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(test::has(message_of([&] { draw_skeleton(endless, {}, {}); }), "column 2, row 1"));
}

TEST(DrawSkeleton, GroundsOuterEdgesBelongToItsOutermostCells) {
    EXPECT_EQ(picture(draw_skeleton(dry(3, 3), one_ridge({{0.0, 3.0, 1.0}, {3.0, 0.0, 5.0}}), {}).skeleton.z),
              "1..\n.3.\n..5\n");
    EXPECT_EQ(picture(draw_skeleton(dry(2, 2), {}, {{{2.0, 0.0, 7.0}}, ""}).skeleton.z), "..\n.7\n");
}

TEST(DrawSkeleton, ALineWithinACellIsThatCell) {
    EXPECT_EQ(
        picture(
            draw_skeleton(dry(2, 1), one_ridge({{0.2, 0.5, 1.0}, {0.4, 0.5, 3.0}, {0.6, 0.5, 2.0}}), {}).skeleton.z),
        "3.\n");
    EXPECT_EQ(picture(draw_skeleton(dry(2, 1), one_ridge({{0.2, 0.5, 4.0}, {0.2, 0.5, 4.0}}), {},
                                    {.noise = {.amplitude_m = 50.0}})
                          .skeleton.z),
              "4.\n");
}

TEST(DrawSkeleton, RiversThenPointsThenRidges) {
    Valley valley = dry(5, 3);
    for (std::int64_t col = 0; col < 5; ++col) {
        valley.z[Cell{col, 2}] = 3.0F;
    }
    RidgeLines const ridges{{{{{0.5, 2.5, 9.0}, {4.5, 2.5, 5.0}}, 1, 2}, {{{2.5, 2.5, 1.0}, {2.5, 0.5, 1.0}}, 1, 2}}};
    FeaturePoints const points{{{1.5, 2.5, 2.0}, {1.5, 0.5, 8.0}, {1.2, 2.2, 1.0}, {0.5, 1.5, 4.0}}, ""};
    DrawnSkeleton const drawn = draw_skeleton(valley, ridges, points);
    EXPECT_EQ(picture(drawn.skeleton.z), "92765\n4.1..\n33333\n");
    EXPECT_EQ(drawn.river_cells, 5);
    EXPECT_EQ(drawn.point_cells, 2);
    EXPECT_EQ(drawn.ridge_cells, 5);
    EXPECT_EQ(drawn.under_rivers, 2); // the second ridge's end, and a point
    EXPECT_EQ(drawn.below_river, 1);  // the second ridge beside the river; points do not count
}

TEST(DrawSkeleton, EveryCellIsWhatAPlainSearchSays) {
    ASSERT_TRUE(rc::check([] {
        Scene const scene = any_scene();
        Grid const& grid = scene.valley.z.grid();
        DrawnSkeleton const drawn = draw_skeleton(scene.valley, scene.ridges, scene.points);
        auto const ridge_z = ridge_heights(scene);
        Raster<float> expected = scene.valley.z;
        std::int64_t rivers = 0;
        std::int64_t ridges = 0;
        std::int64_t points = 0;
        std::int64_t under = 0;
        std::int64_t below = 0;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            std::set<float> point_z;
            for (Vec3 const& p : scene.points.points) {
                if (cell_in(grid, p) == grid.at(i)) {
                    point_z.insert(static_cast<float>(p.z));
                }
            }
            if (!std::isnan(scene.valley.z[i])) {
                ++rivers;
                under += !point_z.empty() || ridge_z.contains(i) ? 1 : 0;
            } else if (!point_z.empty()) {
                ++points;
                expected[i] = *point_z.rbegin();
            } else if (ridge_z.contains(i)) {
                ++ridges;
                expected[i] = *ridge_z.at(i).rbegin();
                bool low = false;
                for (std::int64_t j = 0; j < grid.cells(); ++j) {
                    bool const beside = std::abs(grid.at(i).col - grid.at(j).col) <= 1 &&
                                        std::abs(grid.at(i).row - grid.at(j).row) <= 1;
                    low = low || (beside && scene.valley.z[j] > expected[i]);
                }
                below += low ? 1 : 0;
            }
        }
        RC_ASSERT(same_bits(drawn.skeleton.z, expected));
        RC_ASSERT(drawn.river_cells == rivers);
        RC_ASSERT(drawn.ridge_cells == ridges);
        RC_ASSERT(drawn.point_cells == points);
        RC_ASSERT(drawn.under_rivers == under);
        RC_ASSERT(drawn.below_river == below);
    }));
}

TEST(DrawSkeleton, TheOrderOfFeaturesDoesNotMatter) {
    ASSERT_TRUE(rc::check([] {
        Scene scene = any_scene();
        skeleton::DrawSkeletonParams const params{.noise = {3, 5.0, 4.0}};
        Raster<float> const z = draw_skeleton(scene.valley, scene.ridges, scene.points, params).skeleton.z;
        std::ranges::reverse(scene.ridges.lines);
        std::ranges::reverse(scene.points.points);
        RC_ASSERT(same_bits(draw_skeleton(scene.valley, scene.ridges, scene.points, params).skeleton.z, z));
    }));
}

TEST(DrawSkeleton, NoiseMovesRidgesAloneAndNotTheirEnds) {
    Valley valley = dry(400, 60);
    for (std::int64_t row = 0; row < 60; ++row) {
        valley.z[Cell{200, row}] = 1.0F;
    }
    RidgeLines const ridges = one_ridge({{0.5, 20.5, 10.0}, {150.5, 40.5, 40.0}, {399.5, 30.5, 20.0}});
    FeaturePoints const points{{{100.5, 10.5, 5.0}}, ""};
    Raster<float> const still = draw_skeleton(valley, ridges, points).skeleton.z;
    Raster<float> const noisy = draw_skeleton(valley, ridges, points, {.noise = {3, 6.0, 50.0}}).skeleton.z;
    Raster<float> const other = draw_skeleton(valley, ridges, points, {.noise = {4, 6.0, 50.0}}).skeleton.z;
    std::int64_t moved = 0;
    std::int64_t differ = 0;
    for (std::int64_t i = 0; i < still.cells(); ++i) {
        ASSERT_EQ(std::isnan(still[i]), std::isnan(noisy[i]));
        if (!std::isnan(still[i])) {
            double const share = (static_cast<double>(still.grid().at(i).col) + 0.5) / 400.0;
            EXPECT_LE(std::fabs(noisy[i] - still[i]), 6.0 * 4.0 * share * (1.0 - share) + 0.1);
            moved += noisy[i] != still[i] ? 1 : 0;
            differ += noisy[i] != other[i] ? 1 : 0;
        }
    }
    EXPECT_GT(moved, 380);
    EXPECT_LE(moved, 397); // not the ends, not the river
    EXPECT_GT(differ, 380);
    EXPECT_EQ((noisy[Cell{0, 39}]), 10.0F);
    EXPECT_EQ((noisy[Cell{399, 29}]), 20.0F);
    EXPECT_EQ((noisy[Cell{200, 24}]), 1.0F);
    EXPECT_EQ((noisy[Cell{100, 49}]), 5.0F);
}

TEST(NoiseAlong, RefusesWhatIsNoNoiseOrNoLine) {
    EXPECT_TRUE(noise_along({}, {}).empty());
    EXPECT_THROW(noise_along({}, {}, {.amplitude_m = -1.0}), BadParameter);
    EXPECT_THROW(noise_along({}, {}, {.amplitude_m = not_a_number}), BadParameter);
    EXPECT_THROW(noise_along({}, {}, {.wavelength_m = 0.0}), BadParameter);
    EXPECT_THROW(noise_along({}, {}, {.wavelength_m = not_a_number}), BadParameter);
    for (PlaceOnLine const& bad : {PlaceOnLine{{not_a_number, 0.0}, 0.5},
                                   {{0.0, not_a_number}, 0.5},
                                   {{0.0, 0.0}, -0.1},
                                   {{0.0, 0.0}, 1.1},
                                   {{0.0, 0.0}, not_a_number}}) {
        EXPECT_THROW(noise_along({bad}, {}), BadInput);
    }
    EXPECT_THROW(noise_along({{{2e6, 0.0}, 0.5}}, {}, {.wavelength_m = 1.0}), BadInput);
    EXPECT_THROW(noise_along({{{2.0, 0.0}, 0.5}}, {}, {.amplitude_m = 1.0, .wavelength_m = 1e-308}), BadInput);
    EXPECT_TRUE(has(message_of<BadInput>([&] {
                        noise_along({{{1.0, 2.0}, 0.5}, {{3.0, 4.0}, 2.0}}, {});
                    }),
                    "place 1 at (3, 4)"));
    std::stop_source stop;
    stop.request_stop();
    thalweg::Run run;
    run.stop = stop.get_token();
    EXPECT_THROW(noise_along(parallel(3, 1.0), {}, {}, run), Cancelled);
}

TEST(NoiseAlong, IsZeroInTheEndsAndWithinTheAmplitude) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        double const amplitude = *rc::gen::element(0.0, 0.5, 30.0, 1000.0);
        Vec2 const at{static_cast<double>(*rc::gen::inRange(-1000000, 1000000)) / 7.0,
                      static_cast<double>(*rc::gen::inRange(-1000000, 1000000)) / 7.0};
        std::vector<PlaceOnLine> places;
        for (int i = 0; i <= 16; ++i) {
            places.push_back({at, i / 16.0});
        }
        auto const noise = noise_along(places, {}, {seed, amplitude, 300.0});
        RC_ASSERT(noise.front() == 0.0);
        RC_ASSERT(noise.back() == 0.0);
        for (int i = 0; i <= 16; ++i) {
            // At one place the noise follows the share alone.
            double const here = noise[static_cast<std::size_t>(i)];
            RC_ASSERT(std::fabs(here) <= amplitude);
            RC_ASSERT(std::fabs(here - noise[8] * 4.0 * (i / 16.0) * (1.0 - i / 16.0)) <= 1e-12 * amplitude);
        }
    }));
}

TEST(NoiseAlong, CountsFromTheOrigin) {
    auto const places = parallel(200, 32.0);
    auto moved = places;
    for (PlaceOnLine& place : moved) {
        place.at = {place.at.x + 65536.0, place.at.y - 4096.0};
    }
    NoiseAlongParams const params{7, 40.0, 1024.0};
    Vec2 const origin{500000.0, 4000000.0};
    EXPECT_EQ(noise_along(places, origin, params), noise_along(moved, {origin.x + 65536.0, origin.y - 4096.0}, params));
    EXPECT_NE(noise_along(places, origin, params), noise_along(moved, origin, params));
}

TEST(NoiseAlong, IsAFieldOfFourOctaves) {
    for (std::uint64_t const seed : {1U, 2U, 3U}) {
        // 1024 places a wavelength, 40 wavelengths.
        auto const f = noise_along(parallel(40 * 1024, 1.0), {500000.0, 4000000.0}, {seed, 100.0, 1024.0});
        EXPECT_GT(*std::max_element(f.begin(), f.end()), 15.0);
        EXPECT_LT(*std::min_element(f.begin(), f.end()), -15.0);
        // A fractal down to an eighth of the wavelength: each doubling of the lag less than doubles the rise's root;
        // smooth below: it doubles it.
        EXPECT_NEAR(std::sqrt(rise(f, 4) / rise(f, 2)), 2.0, 0.02);
        EXPECT_NEAR(std::sqrt(rise(f, 8) / rise(f, 4)), 2.0, 0.05);
        EXPECT_LT(std::sqrt(rise(f, 256) / rise(f, 128)), 1.8);
        EXPECT_LT(std::sqrt(rise(f, 4096) / rise(f, 2048)), 1.25);
    }
}

TEST(NoiseAlong, EverySeedHasItsOwn) {
    auto const places = parallel(64, 100.0);
    std::vector<std::vector<double>> all;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        all.push_back(noise_along(places, {500000.0, 4000000.0}, {seed, 1.0, 1000.0}));
        all.push_back(noise_along(places, {500000.0, 4000000.0}, {seed << 40U, 1.0, 1000.0}));
    }
    all.erase(all.begin() + 1); // 0 << 40
    std::sort(all.begin(), all.end());
    EXPECT_EQ(std::unique(all.begin(), all.end()), all.end());
}

} // namespace draw_skeleton_test
