// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/regress.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/skeleton/scatter.hpp>

namespace regress_test {

using namespace thalweg;
using namespace thalweg::skeleton;

namespace {

using test::on_threads;

Grid const ground{130, 40, 300.0, 0.0, 12000.0, ""};

FeaturePoints some_points(std::int64_t count, std::uint64_t seed = 7) {
    return scatter(ground, {.seed = seed, .count = count, .mean_m = 536.0, .std_m = 131.6}).points;
}

double residuals(FeaturePoints const& points, Raster<float> const& surface) {
    double sum = 0.0;
    for (Vec3 const& p : points.points) {
        Cell const c = ground.cell_of({p.x, p.y});
        sum += std::pow(static_cast<double>(surface[c]) - p.z, 2);
    }
    return std::sqrt(sum / static_cast<double>(points.points.size()));
}

/// Points in the middles of cells, so that the surface can be read there.
FeaturePoints at_centres(FeaturePoints points) {
    for (Vec3& p : points.points) {
        Vec2 const centre = ground.centre(ground.cell_of({p.x, p.y}));
        p.x = centre.x;
        p.y = centre.y;
    }
    return points;
}

double mean_square_slope(Raster<float> const& s) {
    double sum = 0.0;
    for (std::int64_t r = 1; r + 1 < s.height(); ++r) {
        for (std::int64_t c = 1; c + 1 < s.width(); ++c) {
            double const dx = 0.5 * (static_cast<double>(s[Cell{c + 1, r}]) - static_cast<double>(s[Cell{c - 1, r}]));
            double const dy = 0.5 * (static_cast<double>(s[Cell{c, r + 1}]) - static_cast<double>(s[Cell{c, r - 1}]));
            sum += dx * dx + dy * dy;
        }
    }
    return sum / static_cast<double>((s.height() - 2) * (s.width() - 2));
}

} // namespace

TEST(Regress, RefusesWhatCannotBe) {
    EXPECT_THROW(regress(some_points(11), ground), BadInput);
    EXPECT_THROW(regress(some_points(20), Grid{}), BadParameter);
    EXPECT_THROW(regress(some_points(20), ground, {.length_x = 0.0}), BadParameter);
    EXPECT_THROW(regress(some_points(20), ground, {.frequency_y = -1.0}), BadParameter);
    EXPECT_THROW(regress(some_points(20), ground, {.slope = SlopeMode::centre, .slope_rad = 1.6}), BadParameter);
    FeaturePoints bad = some_points(20);
    bad.points[3].z = NAN;
    EXPECT_THROW(regress(bad, ground), BadInput);
    FeaturePoints same = some_points(20);
    for (Vec3& p : same.points) {
        p.x = same.points[0].x;
        p.y = same.points[0].y;
    }
    EXPECT_EQ(regress(same, ground).rank, 1U);
    Regression const steep = regress(same, ground, {.slope = SlopeMode::mean, .slope_rad = 0.5});
    EXPECT_EQ(steep.rank, 1U);
    EXPECT_LE(steep.slope_error, 1e-10);
}

TEST(Regress, FindsASurfaceOfItsOwnTermsAgain) {
    FeaturePoints points = at_centres(some_points(60));
    for (Vec3& p : points.points) {
        double const x = (p.x - 19500.0) / 300.0;
        double const y = (p.y - 6000.0) / 300.0;
        double const hill = std::exp(-std::fabs(x) / 20.68 - std::fabs(y) / 39.74);
        p.z = 500.0 + 3.0 * x - 2.0 * y + 0.01 * x * x * y * y +
              hill * (80.0 - 40.0 * std::cos(2.0 * M_PI * 2.0 * std::fabs(x) / 130.0) +
                      30.0 * std::sin(2.0 * M_PI * std::fabs(y) / 40.0));
    }
    Regression const r =
        regress(points, ground, {.length_x = 20.68, .length_y = 39.74, .frequency_x = 2.0, .frequency_y = 1.0});
    EXPECT_EQ(r.rank, 12U);
    EXPECT_LT(r.rms_m, 1e-9);
    EXPECT_NEAR(r.coefficients[1], 3.0 * 64.5, 1e-6);
    EXPECT_NEAR(r.coefficients[2], -2.0 * 19.5, 1e-6);
    EXPECT_NEAR(r.coefficients[7], 0.01 * 64.5 * 64.5 * 19.5 * 19.5, 1e-4);
    EXPECT_NEAR(r.coefficients[9], 80.0, 1e-6);
    EXPECT_NEAR(r.coefficients[10], -40.0, 1e-6);
    EXPECT_NEAR(r.coefficients[11], 30.0, 1e-6);
    EXPECT_LT(residuals(points, r.surface), 1e-3);
}

TEST(Regress, TheEighthTermAsPrinted) {
    FeaturePoints points = at_centres(some_points(60));
    for (Vec3& p : points.points) {
        double const u = (p.x - 19500.0) / 300.0 / 64.5;
        double const v = (p.y - 6000.0) / 300.0 / 19.5;
        p.z = 100.0 * u * u * u * v;
    }
    EXPECT_LT(regress(points, ground, {.eighth = EighthTerm::x3y}).rms_m, 1e-9);
    EXPECT_GT(regress(points, ground).rms_m, 1.0);
}

TEST(Regress, TermsWithoutFrequencyAreLeftOut) {
    Regression const r = regress(some_points(50), ground, {.frequency_x = 0.0, .frequency_y = 0.0});
    EXPECT_EQ(r.terms, 10U);
    EXPECT_EQ(r.rank, 10U);
    EXPECT_EQ(r.coefficients[10], 0.0);
    EXPECT_EQ(r.coefficients[11], 0.0);
}

TEST(Regress, HoldsTheSlopeOfTheMiddleToTenDigits) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        FeaturePoints const points = some_points(50, seed);
        for (double const slope : {0.1, 1.0, 1.499}) {
            Regression const r = regress(
                points, ground, {.length_x = 20.68, .length_y = 39.74, .slope = SlopeMode::centre, .slope_rad = slope});
            EXPECT_LE(r.slope_error, 1e-10);
            double const to_x = r.coefficients[1] / 64.5;
            double const to_y = r.coefficients[2] / 19.5;
            EXPECT_NEAR(std::atan(std::hypot(to_x, to_y)), slope, 1e-10);
            EXPECT_GE(r.rms_m, regress(points, ground, {.length_x = 20.68, .length_y = 39.74}).rms_m);
        }
    }
}

TEST(Regress, HoldsTheMeanSlopeOfTheGrid) {
    for (double const slope : {0.5, 1.2}) {
        Regression const r = regress(some_points(80), ground, {.slope = SlopeMode::mean, .slope_rad = slope});
        EXPECT_LE(r.slope_error, 1e-10);
        // By differences of the surface, without its outermost cells and with rounded creases: nearly the same.
        EXPECT_NEAR(std::sqrt(mean_square_slope(r.surface)) / std::tan(slope), 1.0, 0.15);
    }
}

TEST(Regress, OfMirroredPointsTheSurfaceIsMirrored) {
    Grid const odd{9, 7, 1.0, 0.0, 7.0, ""}; // its middle column and row lie on the creases
    RegressParams const params{.length_x = 3.0, .length_y = 2.0, .slope = SlopeMode::mean, .slope_rad = 0.5};
    FeaturePoints const points = scatter(odd, {.count = 30, .mean_m = 5.0, .std_m = 2.0}).points;
    Raster<float> const surface = regress(points, odd, params).surface;
    for (bool const across : {false, true}) {
        FeaturePoints mirrored = points;
        for (Vec3& p : mirrored.points) {
            p = across ? Vec3{p.x, 7.0 - p.y, p.z} : Vec3{9.0 - p.x, p.y, p.z};
        }
        Raster<float> const other = regress(mirrored, odd, params).surface;
        for (std::int64_t i = 0; i < odd.cells(); ++i) {
            Cell const c = odd.at(i);
            EXPECT_NEAR(surface[c], (other[across ? Cell{c.col, 6 - c.row} : Cell{8 - c.col, c.row}]), 1e-4);
        }
    }
}

TEST(Regress, ASingleRowAndMoreThreads) {
    Grid const row{50, 1, 1.0, 0.0, 1.0, ""};
    FeaturePoints points;
    for (int i = 0; i < 50; ++i) {
        points.points.push_back({i + 0.5, 0.5, static_cast<double>(i % 7)});
    }
    Regression const flat = regress(points, row);
    EXPECT_LT(flat.rank, flat.terms);
    for (float const z : flat.surface.values()) {
        EXPECT_TRUE(std::isfinite(z));
    }
    thalweg::Run const one = on_threads(1);
    thalweg::Run const two = on_threads(2);
    Regression const a = regress(some_points(50), ground, {}, one);
    Regression const b = regress(some_points(50), ground, {}, two);
    EXPECT_TRUE(std::equal(a.surface.values().begin(), a.surface.values().end(), b.surface.values().begin()));
}

} // namespace regress_test
