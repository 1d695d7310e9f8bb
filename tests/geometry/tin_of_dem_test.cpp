// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/tin_of_dem.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>
#include <tins.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

namespace tin_of_dem_test {

using namespace thalweg;
using geometry::tin_of_dem;

namespace {

using test::has;
using test::message_of;

constexpr float none = std::numeric_limits<float>::quiet_NaN();

template <class Height> Raster<float> raster(std::int64_t width, std::int64_t height, Height z) {
    return test::raster_of({width, height, 10.0, 300000.0, 4000000.0, ""}, z);
}

/// Hills, with a little roughness.
Raster<float> hills(std::int64_t width, std::int64_t height, std::uint64_t seed) {
    double const phase = 6.0 * unit(random_word(seed, 1));
    return raster(width, height, [&](Cell c) {
        auto const x = static_cast<double>(c.col);
        auto const y = static_cast<double>(c.row);
        return 300.0 + 40.0 * portable::sin(0.21 * x + phase) + 30.0 * portable::cos(0.17 * y - 0.08 * x) +
               5.0 * unit(random_word(seed, 2, static_cast<std::uint64_t>(c.col), static_cast<std::uint64_t>(c.row)));
    });
}

std::string refusal(Raster<float> const& dem, double error_m = 1.0) {
    return message_of([&] { tin_of_dem(dem, {error_m}); });
}

/// Raster of the TIN against the DEM: every cell with data but those left out, and no other. Half a unit in the last
/// place of a float is what rasters take from heights.
void expect_within(Raster<float> const& dem, geometry::SimplifiedDem const& s, double error_m) {
    auto const drawn = surface::rasterise_tin(s.tin, dem.grid());
    std::int64_t missing = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isnan(dem[i])) {
            RC_ASSERT(std::isnan(drawn[i]));
        } else if (std::isnan(drawn[i])) {
            ++missing;
        } else {
            RC_ASSERT(std::fabs(static_cast<double>(drawn[i]) - static_cast<double>(dem[i])) <= error_m + 2e-5);
        }
    }
    RC_ASSERT(missing == s.left_out);
    RC_ASSERT(s.error_m <= error_m);
}

/// Plain greedy insertion: after every cell all errors anew, triangles found by looking at all, Bowyer and Watson's
/// cavity. Gives the number of triangles.
class PlainGreedy {
public:
    explicit PlainGreedy(Raster<float> const& dem) : dem_(dem) {
        std::int64_t const w = dem.width() - 1;
        std::int64_t const h = dem.height() - 1;
        triangles_ = {{Cell{0, 0}, Cell{0, h}, Cell{w, h}}, {Cell{0, 0}, Cell{w, h}, Cell{w, 0}}};
    }
    std::size_t refine(double error_m) {
        for (;;) {
            double worst = error_m;
            Cell at{-1, -1};
            for (std::int64_t i = 0; i < dem_.cells(); ++i) {
                double const error = std::fabs(height(dem_.grid().at(i)) - static_cast<double>(dem_[i]));
                if (error > worst) {
                    worst = error;
                    at = dem_.grid().at(i);
                }
            }
            if (at.col < 0) {
                return triangles_.size();
            }
            insert(at);
        }
    }

private:
    using Triangle = std::array<Cell, 3>;

    // Positive for a left turn as a map is seen: rows grow to the south.
    static std::int64_t turn(Cell a, Cell b, Cell c) {
        return (b.row - a.row) * (c.col - a.col) - (b.col - a.col) * (c.row - a.row);
    }
    static bool holds(Triangle const& t, Cell p) {
        return turn(t[0], t[1], p) >= 0 && turn(t[1], t[2], p) >= 0 && turn(t[2], t[0], p) >= 0;
    }
    static bool in_circle(Triangle const& t, Cell p) {
        std::int64_t sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            Cell const a = t[k];
            sum += turn(p, t[(k + 1) % 3], t[(k + 2) % 3]) *
                   ((a.col - p.col) * (a.col - p.col) + (a.row - p.row) * (a.row - p.row));
        }
        return sum > 0;
    }
    double height(Cell p) const {
        for (Triangle const& t : triangles_) {
            if (holds(t, p)) {
                double z = 0.0;
                for (std::size_t k = 0; k < 3; ++k) {
                    z += static_cast<double>(turn(p, t[(k + 1) % 3], t[(k + 2) % 3])) * static_cast<double>(dem_[t[k]]);
                }
                return z / static_cast<double>(turn(t[0], t[1], t[2]));
            }
        }
        return 0.0;
    }
    void insert(Cell p) {
        std::vector<std::pair<Cell, Cell>> sides;
        std::vector<Triangle> kept;
        for (Triangle const& t : triangles_) {
            if (!holds(t, p) && !in_circle(t, p)) {
                kept.push_back(t);
                continue;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                std::pair const side(t[k], t[(k + 1) % 3]);
                auto const twin = std::ranges::find(sides, std::pair(side.second, side.first));
                if (twin != sides.end()) {
                    sides.erase(twin);
                } else {
                    sides.push_back(side);
                }
            }
        }
        for (auto const& [a, b] : sides) {
            if (turn(p, a, b) > 0) {
                kept.push_back({p, a, b});
            }
        }
        triangles_ = kept;
    }

    Raster<float> const& dem_;
    std::vector<Triangle> triangles_;
};

} // namespace

TEST(TinOfDem, BadInputIsRefused) {
    auto const flat = raster(4, 4, [](Cell) { return 1.0; });
    EXPECT_TRUE(has(refusal(flat, 0.0), "error is 0 m"));
    EXPECT_TRUE(has(refusal(flat, -1.0), "error is -1 m"));
    EXPECT_TRUE(has(refusal(flat, std::numeric_limits<double>::quiet_NaN()), "greater than 0"));
    EXPECT_TRUE(has(refusal(Raster<float>()), "of 0 x 0 cells 0 have data"));
    EXPECT_TRUE(has(refusal(raster(1, 9, [](Cell) { return 1.0; })), "of 1 x 9 cells 9 have data"));
    EXPECT_TRUE(has(refusal(raster(9, 1, [](Cell) { return 1.0; })), "no triangles"));
    EXPECT_TRUE(has(refusal(raster(3, 3, [](Cell) { return none; })), "of 3 x 3 cells 0 have data"));
    EXPECT_TRUE(
        has(refusal(raster(3, 3, [](Cell c) { return (c.col + c.row) % 2 == 0 ? 1.0F : none; })), "5 have data"));
    EXPECT_TRUE(has(refusal(raster(3, 3,
                                   [](Cell c) {
                                       return c == Cell{1, 2} ? INFINITY : 0.0F;
                                   })),
                    "column 1, row 2"));
}

TEST(TinOfDem, PlaneIsTwoTriangles) {
    for (auto const& [w, h] : {std::pair{2, 2}, std::pair{2, 50}, std::pair{40, 30}}) {
        auto const dem = raster(w, h, [](Cell c) { return 3.0 * static_cast<double>(c.col - 2 * c.row); });
        auto const s = tin_of_dem(dem, {1e-6});
        EXPECT_EQ(s.tin.triangles.size(), 2U);
        EXPECT_EQ(s.tin.vertices.size(), 4U);
        EXPECT_EQ(s.left_out, 0);
        EXPECT_EQ(s.tin.vertices[0], (Vec3{300005.0, 3999995.0, 0.0}));
    }
}

TEST(TinOfDem, OnePeak) {
    auto const s = tin_of_dem(raster(5, 5, [](Cell c) { return c == Cell{2, 1} ? 9.0 : 0.0; }), {0.5});
    EXPECT_TRUE(test::is_lawful(s.tin));
    EXPECT_EQ(std::ranges::count_if(s.tin.vertices, [](Vec3 const& v) { return v.z == 9.0; }), 1);
}

TEST(TinOfDem, LonelyCellsAreCounted) {
    auto const dem = raster(8, 8, [](Cell c) {
        return (c.col < 3 && c.row < 3) || c == Cell{6, 6} || (c.row == 0 && c.col < 5) ? static_cast<float>(c.col)
                                                                                        : none;
    });
    auto const s = tin_of_dem(dem);
    EXPECT_EQ(s.left_out, 2); // the lone one and the end of the line; its beginning meets two cells below
    expect_within(dem, s, 1.0);
}

// Law: every cell with data lies within the error, where there is none there is no triangle.
TEST(TinOfDem, ErrorHoldsAtEveryCell) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30);
        auto dem = hills(*rc::gen::inRange(2, 50), *rc::gen::inRange(2, 50), seed);
        double const share = *rc::gen::element(0.0, 0.0, 0.02, 0.3);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (unit(random_word(seed, 3, static_cast<std::uint64_t>(i))) < share) {
                dem[i] = none;
            }
        }
        bool const round_lake = *rc::gen::element(false, true);
        for (std::int64_t i = 0; round_lake && i < dem.cells(); ++i) {
            Cell const c = dem.grid().at(i);
            if ((c.col - 20) * (c.col - 20) + (c.row - 18) * (c.row - 18) < 60) {
                dem[i] = none;
            }
        }
        double const error_m = *rc::gen::element(0.01, 0.5, 2.0, 10.0, 1000.0);
        geometry::SimplifiedDem s;
        try {
            s = tin_of_dem(dem, {error_m});
        } catch (BadInput const& e) {
            RC_ASSERT(has(e.what(), "no triangles"));
            return;
        }
        RC_ASSERT(test::is_lawful(s.tin));
        expect_within(dem, s, error_m);
    }));
}

TEST(TinOfDem, NeedsNoMoreTrianglesThanPlainGreedyInsertion) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        auto const dem = hills(30, 26, seed);
        double const error_m = seed % 2 == 0 ? 3.0 : 1.5;
        auto const own = static_cast<double>(tin_of_dem(dem, {error_m}).tin.triangles.size());
        auto const plain = static_cast<double>(PlainGreedy(dem).refine(error_m));
        EXPECT_LE(own, 1.1 * plain) << seed;
        sum += own / plain;
    }
    EXPECT_NEAR(sum / 6.0, 1.0, 0.02);
}

TEST(TinOfDem, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    thalweg::Run run;
    run.stop = stop.get_token();
    EXPECT_THROW(tin_of_dem(hills(9, 9, 1), {}, run), Cancelled);
}

} // namespace tin_of_dem_test
