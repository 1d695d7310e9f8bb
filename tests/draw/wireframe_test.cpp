// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/wireframe.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/draw/wireframe.hpp>

#include "pictures.hpp"
#include "small_land.hpp"

namespace wireframe_test {

using namespace thalweg;
using draw::Format;
using draw::hidden_lines;
using draw::Net;
using draw::Seen;
using draw::WireframeParams;

namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

std::size_t dark_pixels(test::Pixels const& pixels) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 2 < pixels.rgb.size(); i += 3) {
        count += pixels.rgb[i] < 128 && pixels.rgb[i + 2] < 128;
    }
    return count;
}

test::Pixels drawn(Raster<float> const& dem, WireframeParams params = {}) {
    params.format = Format::png;
    return test::decode(draw::wireframe({dem}, params).bytes);
}

Raster<float> hill(std::int64_t width, std::int64_t height) {
    Raster<float> dem({width, height, 30.0, 500000.0, 5000000.0, "EPSG:32631"});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        double const x = static_cast<double>(2 * c.col - width) / static_cast<double>(width);
        double const y = static_cast<double>(2 * c.row - height) / static_cast<double>(height);
        dem[i] = static_cast<float>(400.0 / (1.0 + 9.0 * (x * x + y * y)));
    }
    return dem;
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A net over heights seen in parallel projection, with what the oracle needs: depth.
struct Scene {
    Net net;
    std::vector<double> depth; ///< by knot, growing away from the viewer
};

Scene scene_of(std::int64_t columns, std::int64_t rows, std::vector<double> const& z, double bearing, double tilt) {
    Scene scene;
    double const sine = std::sin(bearing);
    double const cosine = std::cos(bearing);
    scene.net.columns = columns;
    scene.net.rows = rows;
    scene.net.away_col = sine > 0.0 ? 1 : -1;
    scene.net.away_row = cosine > 0.0 ? -1 : 1;
    for (std::int64_t row = 0; row < rows; ++row) {
        for (std::int64_t col = 0; col < columns; ++col) {
            double const east = 10.0 * static_cast<double>(col);
            double const north = -10.0 * static_cast<double>(row);
            double const depth = east * sine + north * cosine;
            scene.depth.push_back(depth);
            scene.net.at.push_back(
                {east * cosine - north * sine,
                 depth * std::sin(tilt) + z[static_cast<std::size_t>(row * columns + col)] * std::cos(tilt)});
        }
    }
    return scene;
}

/// Every side of a mesh: its two knots.
std::vector<std::array<std::size_t, 2>> sides_of(Net const& net) {
    std::vector<std::array<std::size_t, 2>> sides;
    auto const knot = [&](std::int64_t col, std::int64_t row) {
        return static_cast<std::size_t>(row * net.columns + col);
    };
    auto const add = [&](std::size_t a, std::size_t b) {
        if (std::isfinite(net.at[a].y) && std::isfinite(net.at[b].y)) {
            sides.push_back({a, b});
        }
    };
    for (std::int64_t row = 0; row < net.rows; ++row) {
        for (std::int64_t col = 0; col < net.columns; ++col) {
            if (col + 1 < net.columns) {
                add(knot(col, row), knot(col + 1, row));
            }
            if (row + 1 < net.rows) {
                add(knot(col, row), knot(col, row + 1));
            }
        }
    }
    return sides;
}

/// How much the highest side nearer to the viewer stands above a point: the oracle asks every side.
double covered_by(Scene const& scene, std::vector<std::array<std::size_t, 2>> const& sides, Vec2 p, double depth) {
    double most = -std::numeric_limits<double>::infinity();
    for (auto const& [a, b] : sides) {
        Vec2 const from = scene.net.at[a];
        Vec2 const to = scene.net.at[b];
        double const share = (p.x - from.x) / (to.x - from.x);
        if (share >= 0.0 && share <= 1.0) {
            double const at = scene.depth[a] + (scene.depth[b] - scene.depth[a]) * share;
            if (at < depth - 1e-9) {
                most = std::max(most, from.y + (to.y - from.y) * share - p.y);
            }
        }
    }
    return most;
}

double distance_to(std::vector<std::vector<Vec2>> const& lines, Vec2 p) {
    double least = std::numeric_limits<double>::infinity();
    for (auto const& line : lines) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            Vec2 const a = line[i - 1];
            Vec2 const d{line[i].x - a.x, line[i].y - a.y};
            double const square = d.x * d.x + d.y * d.y;
            double const share =
                square > 0.0 ? std::clamp(((p.x - a.x) * d.x + (p.y - a.y) * d.y) / square, 0.0, 1.0) : 0.0;
            least = std::min(least, distance(p, {a.x + d.x * share, a.y + d.y * share}));
        }
    }
    return least;
}

/// Every sampled point of every side is drawn or not as the oracle says.
void hold_to_oracle(Scene const& scene, std::string const& what) {
    Seen const seen = hidden_lines(scene.net, {}, 0.0);
    auto const sides = sides_of(scene.net);
    std::size_t shown = 0;
    for (auto const& [a, b] : sides) {
        for (double share : {0.07, 0.21, 0.36, 0.5, 0.63, 0.79, 0.94}) {
            Vec2 const p{scene.net.at[a].x + (scene.net.at[b].x - scene.net.at[a].x) * share,
                         scene.net.at[a].y + (scene.net.at[b].y - scene.net.at[a].y) * share};
            double const depth = scene.depth[a] + (scene.depth[b] - scene.depth[a]) * share;
            double const covered = covered_by(scene, sides, p, depth);
            if (std::fabs(covered) < 1e-3) {
                continue; // at the edge of what hides it
            }
            if (covered < 0.0) {
                ++shown;
                ASSERT_LT(distance_to(seen.net, p), 1e-4)
                    << what << ": a seen point is missing at (" << p.x << ", " << p.y << ")";
            }
        }
    }
    EXPECT_GT(shown, 0U) << what;
    // What is drawn is seen: every piece of every line, by points off its ends.
    for (auto const& line : seen.net) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            for (double share : {0.3, 0.7}) {
                Vec2 const p{line[i - 1].x + (line[i].x - line[i - 1].x) * share,
                             line[i - 1].y + (line[i].y - line[i - 1].y) * share};
                bool is_seen = false; // on some side through this place that nothing covers
                for (auto const& [a, b] : sides) {
                    Vec2 const from = scene.net.at[a];
                    Vec2 const to = scene.net.at[b];
                    double const at = (p.x - from.x) / (to.x - from.x);
                    if (at < -1e-9 || at > 1.0 + 1e-9 || std::fabs(from.y + (to.y - from.y) * at - p.y) > 1e-6) {
                        continue;
                    }
                    double const depth = scene.depth[a] + (scene.depth[b] - scene.depth[a]) * at;
                    is_seen = is_seen || covered_by(scene, sides, p, depth) < 1e-3;
                }
                ASSERT_TRUE(is_seen) << what << ": a hidden point is drawn at (" << p.x << ", " << p.y << ")";
            }
        }
    }
}

} // namespace

TEST(Wireframe, SizesThatAreHardlyLand) {
    for (auto const& [width, height] :
         {std::pair<std::int64_t, std::int64_t>{1, 1}, {1, 9}, {9, 1}, {2, 2}, {1, 3000}, {3000, 1}, {130, 40}}) {
        test::Pixels const pixels = drawn(hill(width, height));
        EXPECT_EQ(pixels.width, 1200U) << width << " x " << height;
        EXPECT_GT(dark_pixels(pixels), 200U) << width << " x " << height;
    }
}

TEST(Wireframe, OneHeightHolesAndNothingAtAll) {
    Grid const grid{20, 20, 30.0, 0.0, 600.0, "EPSG:32631"};
    Raster<float> dem(grid, 1234.5F);
    std::size_t const whole = dark_pixels(drawn(dem));
    for (std::int64_t row = 5; row < 15; ++row) {
        for (std::int64_t col = 5; col < 15; ++col) {
            dem[Cell{col, row}] = none;
        }
    }
    std::size_t const holed = dark_pixels(drawn(dem));
    EXPECT_LT(holed, whole);
    EXPECT_GT(2 * holed, whole);
    EXPECT_GT(drawn(Raster<float>(grid, none)).height, 0U);
}

TEST(Wireframe, AMarginWithoutDataChangesNothing) {
    Raster<float> const land = hill(20, 14);
    Raster<float> framed({26, 18, 30.0, land.grid().west - 90.0, land.grid().north + 60.0, "EPSG:32631"}, none);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        Cell const c = land.grid().at(i);
        framed[Cell{c.col + 3, c.row + 2}] = land[i];
    }
    EXPECT_EQ(drawn(framed).rgb, drawn(land).rgb);
}

TEST(Wireframe, RefusesWhatDoesNotFit) {
    test::SmallLand const land = test::small_land();
    EXPECT_THROW(draw::wireframe({land.dem, &land.network, nullptr}), BadInput);
    EXPECT_THROW(draw::wireframe({Raster<float>()}), BadInput);
    for (auto const& set : std::vector<void (*)(WireframeParams&)>{
             [](WireframeParams& p) { p.width_px = 100; }, [](WireframeParams& p) { p.elevation_deg = 0.0; },
             [](WireframeParams& p) { p.elevation_deg = 90.0; }, [](WireframeParams& p) { p.azimuth_deg = NAN; },
             [](WireframeParams& p) { p.exaggeration = -1.0; }, [](WireframeParams& p) { p.lines = 1; }}) {
        WireframeParams params;
        set(params);
        EXPECT_THROW(draw::wireframe({land.dem}, params), BadParameter);
    }
}

TEST(Wireframe, EveryFormatAndEveryBearing) {
    Raster<float> const dem = hill(500, 500);
    for (double const azimuth : {0.0, 45.0, 90.0, 180.0, 270.0, 359.99, -30.0, 720.0}) {
        WireframeParams params;
        params.azimuth_deg = azimuth;
        std::string const svg = draw::wireframe({dem}, params).bytes;
        EXPECT_TRUE(test::is_xml(svg)) << azimuth;
        EXPECT_LT(svg.size(), 2000000U) << azimuth;
        EXPECT_FALSE(test::has(svg, "nan")) << azimuth;
    }
    WireframeParams params;
    params.title = "谷 <valley> & \"quotes\"";
    EXPECT_TRUE(test::is_xml(draw::wireframe({dem}, params).bytes));
    EXPECT_TRUE(draw::wireframe({dem}, params).bytes == draw::wireframe({dem}, params).bytes);
    params.format = Format::pdf;
    EXPECT_EQ(draw::wireframe({dem}, params).bytes.substr(0, 5), "%PDF-");
}

TEST(Wireframe, ShowsRiversInBlue) {
    test::SmallLand const land = test::small_land();
    WireframeParams params;
    params.format = Format::png;
    EXPECT_EQ(test::river_pixels(test::decode(draw::wireframe({land.dem}, params).bytes)), 0U);
    EXPECT_GT(test::river_pixels(test::decode(draw::wireframe({land.dem, &land.network, &land.orders}, params).bytes)),
              300U);
}

TEST(Wireframe, LooksUpValley) {
    test::SmallLand const land = test::small_land();
    // The outlet is in the south: one looks north, turned off the lines.
    EXPECT_DOUBLE_EQ(draw::azimuth_up_valley({land.dem, &land.network, &land.orders}), 20.0);
    EXPECT_DOUBLE_EQ(draw::azimuth_up_valley({land.dem}), 30.0);
}

TEST(Fishnet, EveryCellWhereTheseAreFew) {
    Raster<float> const dem = hill(5, 3);
    draw::Fishnet const net = draw::fishnet(dem, 60);
    ASSERT_EQ(net.columns, 5);
    ASSERT_EQ(net.rows, 3);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        EXPECT_EQ(net.height_m[static_cast<std::size_t>(i)], static_cast<double>(dem[i]));
    }
}

TEST(Fishnet, NeverMoreLinesThanAskedAndNearlySquare) {
    for (auto const& [width, height] :
         {std::pair<std::int64_t, std::int64_t>{130, 40}, {61, 60}, {1000, 1000}, {4000, 7}, {2, 900}, {60, 60}}) {
        draw::Fishnet const net = draw::fishnet(hill(width, height), 60);
        EXPECT_LE(net.columns, 60);
        EXPECT_LE(net.rows, 60);
        EXPECT_GE(net.columns, 2);
        EXPECT_GE(net.rows, 2);
        EXPECT_EQ(net.col_at.front(), 0.0);
        EXPECT_EQ(net.col_at.back(), static_cast<double>(width - 1));
        EXPECT_EQ(net.row_at.back(), static_cast<double>(height - 1));
    }
    EXPECT_EQ(draw::fishnet(hill(60, 60), 60).columns, 60);
    EXPECT_EQ(draw::fishnet(hill(130, 40), 60).rows, 19);
}

TEST(HiddenLines, OfNothingAndOfOneKnot) {
    EXPECT_TRUE(hidden_lines({}, {}, 0.0).net.empty());
    EXPECT_TRUE(hidden_lines({1, 1, {{0.0, 0.0}}, 1, 1}, {}, 0.0).net.empty());
    EXPECT_TRUE(hidden_lines({1, 1, {{unknown, unknown}}, 1, 1}, {{{0.0, 0.0}, {3.0, 3.0}}}, 0.0).net.empty());
}

TEST(HiddenLines, LevelLandIsSeenWhole) {
    Scene const scene = scene_of(5, 4, std::vector<double>(20, 7.0), 0.5, 0.6);
    Seen const seen = hidden_lines(scene.net, {}, 0.0);
    EXPECT_EQ(seen.net.size(), 9U) << "one line a row and a column";
    hold_to_oracle(scene, "level");
}

TEST(HiddenLines, AgreesWithTheOracleOnRoughLandFromEverySide) {
    std::mt19937_64 random_word(3); // of the engine itself: no distribution
    auto const unit = [&] { return static_cast<double>(random_word() >> 11U) * 0x1.0p-53; };
    for (int round = 0; round < 40; ++round) {
        std::int64_t const columns = 2 + static_cast<std::int64_t>(9.0 * unit());
        std::int64_t const rows = 2 + static_cast<std::int64_t>(9.0 * unit());
        double const rough = 30.0 * unit();
        std::vector<double> z;
        for (std::int64_t i = 0; i < columns * rows; ++i) {
            z.push_back(round % 3 == 2 && unit() < 0.2 ? unknown : rough * unit());
        }
        z.front() = 1.0; // at least one side stands
        z[1] = 2.0;
        hold_to_oracle(scene_of(columns, rows, z, 6.28 * unit(), 0.15 + 1.2 * unit()),
                       "round " + std::to_string(round));
    }
}

TEST(HiddenLines, ThreadsLieOnTheLandAndVanishBehindHills) {
    std::vector<double> z(25, 0.0);
    Scene const level = scene_of(5, 5, z, 0.3, 0.5);
    std::vector<draw::Thread> const threads{{{0.5, 0.5}, {3.5, 3.5}}, {{-3.0, 2.5}, {9.0, 2.5}}};
    Seen const seen = hidden_lines(level.net, threads, 1e-6);
    ASSERT_EQ(seen.threads.size(), 2U);
    EXPECT_EQ(seen.threads[0].thread, 0U);
    Vec2 const a = level.net.knot(0, 2);
    Vec2 const b = level.net.knot(0, 3);
    Vec2 const edge{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
    EXPECT_LT(distance(seen.threads[1].line.front(), edge), 1e-9) << "it is cut where the net ends";
    for (std::size_t col = 0; col < 5; ++col) {
        z[3 * 5 + col] = 90.0;
    }
    Scene const walled = scene_of(5, 5, z, 0.3, 0.5);
    EXPECT_TRUE(hidden_lines(walled.net, {{{0.5, 1.5}, {3.5, 1.5}}}, 1e-6).threads.empty());
}

// One mesh side after the other: level, back down under it, and up through it.
TEST(HiddenLines, GoldenFold) {
    Net net;
    net.columns = 1;
    net.rows = 4;
    net.away_row = 1;
    net.at = {{0.0, 4.0}, {4.0, 4.0}, {0.0, 2.0}, {4.0, 10.0}};
    Seen const seen = hidden_lines(net, {}, 0.0);
    ASSERT_EQ(seen.net.size(), 2U);
    EXPECT_EQ(seen.net[0], (std::vector<Vec2>{{0.0, 4.0}, {4.0, 4.0}}));
    ASSERT_EQ(seen.net[1].size(), 2U);
    EXPECT_LT(distance(seen.net[1][0], {1.0, 4.0}), 1e-6) << "where it comes up";
    EXPECT_EQ(seen.net[1][1], (Vec2{4.0, 10.0}));
}

} // namespace wireframe_test
