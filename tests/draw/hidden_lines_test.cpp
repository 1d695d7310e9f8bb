// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/wireframe.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace hidden_lines_test {

using namespace thalweg;
using draw::hidden_lines;
using draw::Net;
using draw::Seen;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

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

TEST(HiddenLines, OfNothingAndOfOneKnot) {
    EXPECT_TRUE(hidden_lines({}, {}, 0.0).net.empty());
    EXPECT_TRUE(hidden_lines({1, 1, {{0.0, 0.0}}, 1, 1}, {}, 0.0).net.empty());
    EXPECT_TRUE(hidden_lines({1, 1, {{none, none}}, 1, 1}, {{{0.0, 0.0}, {3.0, 3.0}}}, 0.0).net.empty());
}

TEST(HiddenLines, LevelLandIsSeenWhole) {
    Scene const scene = scene_of(5, 4, std::vector<double>(20, 7.0), 0.5, 0.6);
    Seen const seen = hidden_lines(scene.net, {}, 0.0);
    EXPECT_EQ(seen.net.size(), 9U) << "one line a row and a column";
    hold_to_oracle(scene, "level");
}

TEST(HiddenLines, AWallHidesWhatLiesBehindIt) {
    std::vector<double> z(25, 0.0);
    for (std::size_t col = 0; col < 5; ++col) {
        z[3 * 5 + col] = 40.0; // the row before the front one, looking north
    }
    Scene const scene = scene_of(5, 5, z, 0.2, 0.5);
    hold_to_oracle(scene, "wall");
    // The row behind the wall lies in its shadow but for its west end, past which one looks.
    Seen const seen = hidden_lines(scene.net, {}, 0.0);
    EXPECT_GT(distance_to(seen.net, scene.net.knot(4, 2)), 1.0);
    EXPECT_GT(distance_to(seen.net, scene.net.knot(2, 2)), 1.0);
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
            z.push_back(round % 3 == 2 && unit() < 0.2 ? none : rough * unit());
        }
        z.front() = 1.0; // at least one side stands
        z[1] = 2.0;
        hold_to_oracle(scene_of(columns, rows, z, 6.28 * unit(), 0.15 + 1.2 * unit()),
                       "round " + std::to_string(round));
    }
}

TEST(HiddenLines, HolesHaveNoLines) {
    std::vector<double> z(36, 3.0);
    z[2 * 6 + 3] = none;
    Scene const scene = scene_of(6, 6, z, 0.7, 0.6);
    Seen const seen = hidden_lines(scene.net, {}, 0.0);
    hold_to_oracle(scene, "hole");
    Scene const whole = scene_of(6, 6, std::vector<double>(36, 3.0), 0.7, 0.6);
    EXPECT_GT(distance_to(seen.net, whole.net.knot(3, 2)), 1.0);
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

} // namespace hidden_lines_test
