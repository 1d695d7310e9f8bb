// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/match_statistics.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/fractal/internal/limiter.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/skeleton/random_fields.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>

namespace match_statistics_test {

using namespace thalweg;
using fractal::FixedHeight;
using fractal::match_statistics;
using fractal::MatchedDem;
using fractal::Targets;

namespace {

using test::frame_below;
using test::message_of;
using test::on_threads;

constexpr float hole = std::numeric_limits<float>::quiet_NaN();

/// Table 4 of paper 001.
Targets table_4() {
    Targets targets;
    targets.mean = 536.0;
    targets.std = 131.6;
    targets.max = FixedHeight{{91, 1}, 1038.0};
    targets.min = FixedHeight{{129, 26}, 276.0};
    targets.lx_cells = 20.68;
    targets.ly_cells = 39.74;
    targets.slope_rad = 1.499;
    targets.dimension = 2.39;
    return targets;
}

solver::StableCovariance prior_of(Targets const& t) {
    return solver::with_slope({*t.lx_cells, *t.ly_cells, *t.dimension}, *t.std, *t.slope_rad);
}

Raster<float> land_of(Grid const& grid, Targets const& t, std::uint64_t seed) {
    return skeleton::grf(grid, {.mean = *t.mean, .std = *t.std, .covariance = prior_of(t), .seed = seed}).dem;
}

/// Whether a land has all eight statistics, by measure's own estimates.
bool has_all(Raster<float> const& dem, Targets const& t) {
    auto const is = measure::statistics(dem);
    auto const near = [](double got, double asked) { return std::fabs(got - asked) <= 0.01 * asked; };
    return near(is.mean, *t.mean) && near(is.std, *t.std) && near(is.lx.cells, *t.lx_cells) &&
           near(is.ly.cells, *t.ly_cells) && near(is.slope_rad, *t.slope_rad) &&
           std::fabs(is.dimension - *t.dimension) <= 0.02 && is.max.z == t.max->z && is.max.cell == t.max->cell &&
           is.min.z == t.min->z && is.min.cell == t.min->cell;
}

std::int64_t cells_with(Raster<float> const& dem, double z) {
    return std::count(dem.values().begin(), dem.values().end(), static_cast<float>(z));
}

std::string refusal(Targets const& targets) {
    return message_of<BadParameter>(
        [&] { match_statistics(Raster<float>(frame_below(130, 40, 300.0), 500.0F), targets); });
}

Raster<float> rough(Grid const& grid, std::uint64_t seed) {
    Raster<float> land(grid);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        land[i] = static_cast<float>(100.0 * unit(random_word(seed, static_cast<std::uint64_t>(i))));
    }
    return land;
}

} // namespace

TEST(Project, RefusesWhatNoLandCanHave) {
    Targets t = table_4();
    t.mean = 1100.0;
    EXPECT_TRUE(
        test::has(refusal(t), "a mean of 1100 m is not between the lowest point of 276 m and the highest of 1038 m"));
    t = table_4();
    t.std = 362.0; // sqrt((1038 - 536) (536 - 276)) = 361.28
    EXPECT_TRUE(test::has(refusal(t), "the most is 361.27"));
    t.mean.reset(); // half the relief is the most for any mean
    EXPECT_EQ(refusal(t), "");
    t.std = 382.0;
    EXPECT_TRUE(test::has(refusal(t), "381.000 m"));
    t = table_4();
    t.max->cell = {130, 0};
    EXPECT_TRUE(test::has(refusal(t), "off the grid"));
    t.max->cell = t.min->cell;
    EXPECT_TRUE(test::has(refusal(t), "both at column 129, row 26"));
    t = table_4();
    t.max->z = 200.0;
    EXPECT_TRUE(test::has(refusal(t), "not below"));
    t = {};
    t.max = FixedHeight{{0, 0}, 10.0};
    t.mean = 10.0;
    EXPECT_TRUE(test::has(refusal(t), "mean"));
    for (auto const member :
         {&Targets::std, &Targets::lx_cells, &Targets::ly_cells, &Targets::slope_rad, &Targets::dimension}) {
        t = {};
        t.*member = -1.0;
        EXPECT_NE(refusal(t), "");
        t.*member = std::nan("");
        EXPECT_NE(refusal(t), "");
    }
}

TEST(Project, RefusesBadInputAndParameters) {
    Raster<float> dem(frame_below(9, 9, 300.0), 5.0F);
    EXPECT_THROW(match_statistics(Raster<float>{}, {}), BadInput);
    EXPECT_THROW(match_statistics(Raster<float>(frame_below(3, 3, 300.0), hole), {}), BadInput);
    EXPECT_THROW(match_statistics(dem, {}, {{{9, 0}, 1.0}}), BadInput);
    EXPECT_THROW(match_statistics(dem, {}, {{{1, 1}, 1.0}, {{1, 1}, 2.0}}), BadInput);
    EXPECT_THROW(match_statistics(dem, {}, {{{1, 1}, std::nan("")}}), BadInput);
    EXPECT_THROW(match_statistics(dem, {}, {}, {.iterations = -1}), BadParameter);
    EXPECT_THROW(match_statistics(dem, {}, {}, {.gap_m = 0.0}), BadParameter);
    EXPECT_THROW(match_statistics(dem, {}, {}, {.prior = {.dimension = 2.0}}), BadParameter);
    dem[4] = std::numeric_limits<float>::infinity();
    EXPECT_THROW(match_statistics(dem, {}), BadInput);
    dem[4] = hole;
    Targets t;
    t.min = FixedHeight{{4, 0}, 1.0};
    EXPECT_THROW(match_statistics(dem, t), BadParameter);
    Raster<float> const wide(frame_below(60, 60, 300.0), 1.0F);
    std::vector<FixedHeight> many;
    for (std::int64_t i = 0; i < 2001; ++i) {
        many.push_back({wide.grid().at(i), 1.0});
    }
    EXPECT_THROW(match_statistics(wide, {}, many), BadInput);
}

TEST(Project, NothingAskedForChangesNothing) {
    Targets const t = table_4();
    Raster<float> const land = land_of(frame_below(130, 40, 300.0), t, 1);
    MatchedDem const same = match_statistics(land, {});
    EXPECT_TRUE(same.converged);
    EXPECT_EQ(same.iterations, 0);
    EXPECT_TRUE(std::equal(land.values().begin(), land.values().end(), same.dem.values().begin()));
    EXPECT_TRUE(same.residuals.empty());
}

TEST(Project, Table4ForTwentySeeds) {
    Targets const targets = table_4();
    int met = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        MatchedDem const p = match_statistics(land_of(frame_below(130, 40, 300.0), targets, seed), targets, {},
                                              {.prior = prior_of(targets)});
        EXPECT_EQ(cells_with(p.dem, 1038.0), 1);
        EXPECT_EQ(cells_with(p.dem, 276.0), 1);
        EXPECT_EQ(p.residuals.size(), 8U);
        EXPECT_LE(p.iterations, 8) << seed;
        met += has_all(p.dem, targets) ? 1 : 0;
        EXPECT_EQ(p.converged, p.largest_error <= 1e-4);
    }
    EXPECT_GE(met, 19);
}

TEST(Project, ALandThatIsThereComesBackAsItIs) {
    Targets const targets = table_4();
    auto const first =
        match_statistics(land_of(frame_below(130, 40, 300.0), targets, 3), targets, {}, {.prior = prior_of(targets)});
    auto const second = match_statistics(first.dem, targets, {}, {.prior = prior_of(targets)});
    EXPECT_LE(second.iterations, 3);
    EXPECT_TRUE(has_all(second.dem, targets));
}

TEST(Project, FixedHeightsAreKeptExactly) {
    Targets const targets = table_4();
    Raster<float> const land = land_of(frame_below(130, 40, 300.0), targets, 5);
    Raster<float> const other = land_of(frame_below(130, 40, 300.0), targets, 6);
    std::vector<FixedHeight> fixed;
    for (std::int64_t i = 0; i < 60; ++i) {
        Cell const cell{(i * 37) % 130, (i * 23) % 40};
        fixed.push_back({cell, std::clamp(static_cast<double>(other[cell]), 290.0, 1000.0)});
    }
    MatchedDem const p = match_statistics(land, targets, fixed, {.prior = prior_of(targets)});
    for (FixedHeight const& one : fixed) {
        EXPECT_EQ(p.dem[one.cell], static_cast<float>(one.z));
    }
    EXPECT_TRUE(p.converged);
    EXPECT_TRUE(has_all(p.dem, targets));
}

TEST(Project, WhatContradictsIsMetAsFarAsItCanBe) {
    Targets const targets = table_4();
    // An eighth of all cells are held at one height: the land cannot be so rough.
    std::vector<FixedHeight> fixed;
    for (std::int64_t r = 0; r < 40; ++r) {
        for (std::int64_t c = 0; c < 16; ++c) {
            fixed.push_back({{c, r}, 900.0});
        }
    }
    MatchedDem const p = match_statistics(land_of(frame_below(130, 40, 300.0), targets, 5), targets, fixed,
                                          {.prior = prior_of(targets), .iterations = 12});
    EXPECT_FALSE(p.converged);
    EXPECT_GT(p.largest_error, 1e-4);
    EXPECT_LE(p.iterations, 12);
    for (FixedHeight const& one : fixed) {
        ASSERT_EQ(p.dem[one.cell], 900.0F);
    }
    EXPECT_TRUE(std::none_of(p.dem.values().begin(), p.dem.values().end(), [](float z) { return std::isnan(z); }));
    // A fixed height above the highest point is kept, and told.
    MatchedDem const above = match_statistics(land_of(frame_below(130, 40, 300.0), targets, 5), targets,
                                              {{{5, 5}, 1100.0}}, {.prior = prior_of(targets)});
    EXPECT_EQ((above.dem[Cell{5, 5}]), 1100.0F);
    EXPECT_FALSE(above.converged);
    auto const max =
        std::find_if(above.residuals.begin(), above.residuals.end(), [](auto const& r) { return r.name == "max"; });
    EXPECT_EQ(max->got, 1100.0);
}

TEST(Project, HolesDoNotCountAndStay) {
    Targets const targets = table_4();
    Raster<float> land = land_of(frame_below(130, 40, 300.0), targets, 7);
    std::int64_t holes = 0;
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        Cell const cell = land.grid().at(i);
        if (std::hypot(static_cast<double>(cell.col) - 40.0, static_cast<double>(cell.row) - 20.0) < 15.0) {
            land[i] = hole;
            ++holes;
        }
    }
    MatchedDem const p = match_statistics(land, targets, {}, {.prior = prior_of(targets)});
    EXPECT_TRUE(p.converged);
    EXPECT_TRUE(has_all(p.dem, targets));
    EXPECT_EQ(measure::statistics(p.dem).nodata, holes);
}

TEST(Project, SomeTargetsLeaveTheRestAsItIs) {
    Targets some;
    some.mean = 100.0;
    some.slope_rad = 0.9;
    Raster<float> const land = skeleton::grf(frame_below(50, 30, 300.0), {.mean = 90.0, .std = 10.0, .seed = 2}).dem;
    MatchedDem const p = match_statistics(land, some);
    EXPECT_TRUE(p.converged);
    ASSERT_EQ(p.residuals.size(), 2U);
    EXPECT_NEAR(measure::statistics(p.dem).mean, 100.0, 0.01);
    EXPECT_NEAR(measure::statistics(p.dem).slope_rad, 0.9, 1e-4);
}

TEST(Project, APlainHasNoShapeToStartFrom) {
    Targets targets;
    targets.std = 3.0;
    targets.dimension = 2.4;
    MatchedDem const p = match_statistics(Raster<float>(frame_below(20, 20, 300.0), 5.0F), targets);
    EXPECT_FALSE(p.converged);
    EXPECT_EQ(p.largest_error, std::numeric_limits<double>::infinity());
}

TEST(Project, SameBitsForAnyNumberOfThreads) {
    Targets const targets = table_4();
    Raster<float> const land = land_of(frame_below(130, 40, 300.0), targets, 9);
    thalweg::Run run = on_threads(1);
    auto const one = match_statistics(land, targets, {}, {.prior = prior_of(targets)}, run);
    for (int const threads : {2, 5}) {
        run.threads = threads;
        auto const many = match_statistics(land, targets, {}, {.prior = prior_of(targets)}, run);
        EXPECT_TRUE(std::equal(one.dem.values().begin(), one.dem.values().end(), many.dem.values().begin()));
    }
}

TEST(Project, StopsWhenAsked) {
    std::stop_source source;
    source.request_stop();
    thalweg::Run run;
    run.stop = source.get_token();
    Targets const targets = table_4();
    EXPECT_THROW(match_statistics(Raster<float>(frame_below(130, 40, 300.0), 1.0F), targets, {}, {}, run), Cancelled);
}

TEST(Limiter, IsSmoothAndStaysInside) {
    fractal::Limiter const limiter(table_4(), 0.5);
    double before = limiter.height(-1000.0);
    EXPECT_GE(before, 276.5);
    for (double w = -1000.0; w < 3000.0; w += 0.5) {
        double const h = limiter.height(w);
        EXPECT_LE(h, 1037.5);
        EXPECT_GE(h, before);
        EXPECT_NEAR(limiter.slope(w), (limiter.height(w + 1e-4) - limiter.height(w - 1e-4)) / 2e-4, 1e-5);
        EXPECT_EQ(h == w, !limiter.bends(w));
        before = h;
    }
    EXPECT_EQ(limiter.height(600.0), 600.0);
    fractal::Limiter const none(Targets{}, 0.5);
    EXPECT_EQ(none.height(-1e6), -1e6);
    EXPECT_FALSE(none.bends(1e6));
}

TEST(FineForms, RefuseWhatDoesNotFit) {
    Raster<float> const land(Grid{4, 3, 1.0, 0, 0, ""}, 1.0F);
    EXPECT_THROW(fractal::with_fine_forms(land, land, 0.0), BadParameter);
    EXPECT_THROW(fractal::with_fine_forms(land, Raster<float>(Grid{3, 4, 1.0, 0, 0, ""}), 1.0), BadInput);
    Raster<float> holed = land;
    holed[2] = NAN;
    EXPECT_THROW(fractal::with_fine_forms(land, holed, 1.0), BadInput);
}

TEST(FineForms, OfTheSameLandAreTheSameLand) {
    Raster<float> const land = rough({37, 5, 1.0, 0, 0, ""}, 1);
    Raster<float> const same = fractal::with_fine_forms(land, land, 3.0);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        EXPECT_NEAR(static_cast<double>(same[i]), static_cast<double>(land[i]), 1e-4);
    }
}

TEST(FineForms, MeansComeFromTheOneAndTheRestFromTheOther) {
    Grid const grid{40, 30, 1.0, 0, 0, ""};
    Raster<float> slope = test::raster_of(grid, [&](Cell c) { return 5 * c.col; });
    Raster<float> const other = rough(grid, 2);
    Raster<float> const mixed = fractal::with_fine_forms(slope, other, 2.0);
    // By the definition, one cell at a time, away from the border.
    for (Cell const c : {Cell{15, 12}, Cell{20, 17}}) {
        double sum = 0.0;
        double mean = 0.0;
        for (std::int64_t dr = -6; dr <= 6; ++dr) {
            for (std::int64_t dc = -6; dc <= 6; ++dc) {
                double const weight = std::exp(-0.125 * static_cast<double>(dr * dr + dc * dc));
                sum += weight;
                mean += weight * (static_cast<double>(slope[Cell{c.col + dc, c.row + dr}]) -
                                  static_cast<double>(other[Cell{c.col + dc, c.row + dr}]));
            }
        }
        EXPECT_NEAR(static_cast<double>(mixed[c]), mean / sum + static_cast<double>(other[c]), 1e-4);
    }
    // One cell is its own surroundings.
    Raster<float> const one(Grid{1, 1, 1.0, 0, 0, ""}, 7.0F);
    EXPECT_EQ(fractal::with_fine_forms(one, Raster<float>(one.grid(), 90.0F), 5.0)[0], 7.0F);
}

} // namespace match_statistics_test
