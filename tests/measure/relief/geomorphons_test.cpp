// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/geomorphons.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

#include "dems.hpp"

namespace geomorphons_test {

using namespace thalweg;
using measure::Form;
using measure::GeomorphonParams;
using measure::Geomorphons;
using measure::geomorphons;

namespace {

using test::on_threads;

struct Counts {
    int rise = 0;
    int fall = 0;
};

/// A cell's eight sights, angle by angle.
Counts look(Raster<float> const& dem, Cell at, GeomorphonParams const& params) {
    Counts counts;
    for (Cell const step : d8_steps) {
        double const length = std::sqrt(static_cast<double>(step.col * step.col + step.row * step.row));
        if (std::isnan(dem[Cell{at.col + step.col, at.row + step.row}])) {
            continue;
        }
        double zenith = -90.0;
        double nadir = 90.0;
        for (std::int64_t n = params.skip_cells + 1;
             static_cast<double>(n) * length < static_cast<double>(params.search_cells) - 1e-9; ++n) {
            float const there = dem[Cell{at.col + n * step.col, at.row + n * step.row}];
            if (std::isnan(there)) {
                continue;
            }
            // In whole cells of this direction, so that equal sights are equal.
            double const rise = (static_cast<double>(there) - static_cast<double>(dem[at])) / static_cast<double>(n);
            double const angle = std::atan(rise / (length * dem.grid().cell_m)) * 180.0 / std::numbers::pi;
            zenith = std::max(zenith, angle);
            nadir = std::min(nadir, angle);
        }
        if (std::fabs(zenith) > params.flat_deg || std::fabs(nadir) > params.flat_deg) {
            counts.rise += std::fabs(nadir) < std::fabs(zenith) ? 1 : 0;
            counts.fall += std::fabs(nadir) > std::fabs(zenith) ? 1 : 0;
        }
    }
    return counts;
}

/// Jasiewicz and Stepinski's figure 3, as a rule: by directions that rise and fall.
Form form_of(Counts c) {
    static constexpr char const* table[9] = {"FFFWWVVVD", "FFWWWVVV", "FSLLHHV", "SSLLLH", "SSPLL",
                                             "RRPP",      "RRR",      "RR",      "T"};
    switch (table[c.fall][c.rise]) {
    case 'F': return Form::flat;
    case 'T': return Form::peak;
    case 'R': return Form::ridge;
    case 'S': return Form::shoulder;
    case 'P': return Form::spur;
    case 'L': return Form::slope;
    case 'H': return Form::hollow;
    case 'W': return Form::footslope;
    case 'V': return Form::valley;
    default: return Form::pit;
    }
}

Raster<float> shaped(std::int64_t side, double (*height)(double, double)) {
    Raster<float> dem(frame(side, side));
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        double const middle = static_cast<double>(side - 1) / 2.0;
        dem[i] = static_cast<float>(height(static_cast<double>(c.col) - middle, static_cast<double>(c.row) - middle));
    }
    return dem;
}

Form middle_form(double (*height)(double, double)) {
    return static_cast<Form>(geomorphons(shaped(41, height)).form[Cell{20, 20}]);
}

} // namespace

TEST(Geomorphons, TooSmallOrEmptyHasNoForms) {
    for (Raster<float> const& dem : {Raster<float>{}, dem_of(1, {1.0F}), Raster<float>(frame(30, 100), 2.0F),
                                     Raster<float>(frame(100, 30), 2.0F), Raster<float>(frame(40, 40), hole)}) {
        Geomorphons const found = geomorphons(dem);
        EXPECT_EQ(std::accumulate(found.cells.begin(), found.cells.end(), std::int64_t{0}), 0);
        EXPECT_EQ(found.shares[0], 0.0);
    }
}

TEST(Geomorphons, RefusesNonsense) {
    Raster<float> const dem(frame(40, 40), 1.0F);
    EXPECT_THROW(geomorphons(dem, {.search_cells = 1}), BadParameter);
    EXPECT_THROW(geomorphons(dem, {.search_cells = 10001}), BadParameter);
    EXPECT_THROW(geomorphons(dem, {.search_cells = 5, .skip_cells = 5}), BadParameter);
    EXPECT_THROW(geomorphons(dem, {.skip_cells = -1}), BadParameter);
    EXPECT_THROW(geomorphons(dem, {.flat_deg = 0.0}), BadParameter);
    EXPECT_THROW(geomorphons(dem, {.flat_deg = std::nan("")}), BadParameter);
    Grid none = frame(40, 40);
    none.cell_m = 0.0;
    EXPECT_THROW(geomorphons(Raster<float>(none, 1.0F)), BadInput);
}

TEST(Geomorphons, FormsOfSimpleLand) {
    EXPECT_EQ(middle_form([](double, double) { return 7.0; }), Form::flat);
    EXPECT_EQ(middle_form([](double x, double y) { return -x * x - y * y; }), Form::peak);
    EXPECT_EQ(middle_form([](double x, double y) { return x * x + y * y; }), Form::pit);
    EXPECT_EQ(middle_form([](double x, double) { return -x * x; }), Form::ridge);
    EXPECT_EQ(middle_form([](double x, double) { return x * x; }), Form::valley);
    EXPECT_EQ(middle_form([](double x, double) { return x + 0.01 * x * x; }), Form::slope);
    EXPECT_EQ(middle_form([](double x, double) { return x < 0.0 ? -x * x : 0.0; }), Form::shoulder);
    EXPECT_EQ(middle_form([](double x, double) { return x > 0.0 ? x * x : 0.0; }), Form::footslope);
    // All sights of a straight slope are as steep as one another: none is the steepest.
    EXPECT_EQ(middle_form([](double x, double) { return x; }), Form::flat);
}

// The border has no forms, and everything inside has one.
TEST(Geomorphons, BorderIsLeftOut) {
    Geomorphons const found = geomorphons(rough_dem(frame(21, 17), 3), {.search_cells = 4});
    for (std::int64_t i = 0; i < found.form.cells(); ++i) {
        Cell const c = found.form.grid().at(i);
        bool const inside = c.col >= 4 && c.row >= 4 && c.col < 17 && c.row < 13;
        EXPECT_EQ(found.form[i] != 0, inside);
    }
    EXPECT_EQ(std::accumulate(found.cells.begin(), found.cells.end(), std::int64_t{0}), 13 * 9);
}

// The row by row way finds what looking from each cell finds.
TEST(Geomorphons, AsLookedFromEachCell) {
    ASSERT_TRUE(rc::check("each cell's form is that of its eight sights", [] {
        Raster<float> dem = *gen_dem(24, 20);
        GeomorphonParams params;
        params.search_cells = *evenly<std::int64_t>(2, 9);
        params.skip_cells = *evenly<std::int64_t>(0, params.search_cells - 1);
        params.flat_deg = *rc::gen::element(0.5, 1.0, 20.0);
        Geomorphons const found = geomorphons(dem, params);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Cell const c = dem.grid().at(i);
            std::int64_t const s = params.search_cells;
            bool const inside = c.col >= s && c.row >= s && c.col < dem.width() - s && c.row < dem.height() - s;
            Form const wanted = inside && !std::isnan(dem[i]) ? form_of(look(dem, c, params)) : Form::none;
            RC_ASSERT(static_cast<int>(found.form[i]) == static_cast<int>(wanted));
        }
    }));
}

/// A cell's eight sights in doubles.
Counts exact_look(Raster<float> const& dem, Cell at, GeomorphonParams const& params) {
    double const angle = params.flat_deg * (portable::pi / 180.0);
    Counts counts;
    for (Cell const step : d8_steps) {
        std::int64_t const squared = step.col * step.col + step.row * step.row;
        double const level =
            portable::sin(angle) / portable::cos(angle) * dem.grid().cell_m * std::sqrt(static_cast<double>(squared));
        double up = -std::numeric_limits<double>::infinity();
        double down = std::numeric_limits<double>::infinity();
        for (std::int64_t n = params.skip_cells + 1; n * n * squared < params.search_cells * params.search_cells; ++n) {
            auto const there = static_cast<double>(dem[Cell{at.col + n * step.col, at.row + n * step.row}]);
            double const rise = (there - static_cast<double>(dem[at])) / static_cast<double>(n);
            up = rise > up ? rise : up;
            down = rise < down ? rise : down;
        }
        bool const seen = !std::isnan(dem[Cell{at.col + step.col, at.row + step.row}]);
        if (seen && (std::fabs(up) > level || std::fabs(down) > level)) {
            counts.rise += std::fabs(up) > std::fabs(down) ? 1 : 0;
            counts.fall += std::fabs(down) > std::fabs(up) ? 1 : 0;
        }
    }
    return counts;
}

// Sights are compared in floats; where these do not decide, as doubles do.
TEST(Geomorphons, AsInDoublesWhereFloatsAreInDoubt) {
    ASSERT_TRUE(rc::check("equal sights, sights at the threshold, and heights that floats lose", [] {
        Grid grid = frame(*evenly<std::int64_t>(12, 40), 20);
        GeomorphonParams params;
        params.search_cells = *evenly<std::int64_t>(2, 6);
        params.skip_cells = *evenly<std::int64_t>(0, params.search_cells - 1);
        params.flat_deg = *rc::gen::element(1e-40, 1.0, 44.9);
        double const level = std::tan(params.flat_deg * (std::numbers::pi / 180.0)) * grid.cell_m;
        auto const unit = static_cast<float>(*rc::gen::element(1.0, 1e-42, 1e37, level));
        auto const base = *rc::gen::element(0.0F, 1.0F, 16777216.0F);
        Raster<float> dem(grid);
        auto const seed = static_cast<std::uint64_t>(*evenly<int>(0, 1'000'000));
        std::uint64_t draws = 0;
        auto const below = [&](std::uint64_t n) { return random_word(seed, 1, draws++) % n; };
        for (float& z : dem.values()) {
            z = base + unit * (static_cast<float>(below(7)) - 3.0F);
            z = below(60) == 0 ? std::array{hole, -1e38F, std::numeric_limits<float>::infinity()}[below(3)] : z;
            z = below(4) == 0 ? std::nextafter(z, 0.0F) : z;
        }
        Geomorphons const found = geomorphons(dem, params);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (found.form[i] != 0) {
                RC_ASSERT(found.form[i] == static_cast<std::uint8_t>(form_of(exact_look(dem, grid.at(i), params))));
            }
        }
    }));
}

// A land and the same one turned over: valleys are its ridges. Sights as steep up as down are neither.
TEST(Geomorphons, TurnedOverValleysAreRidges) {
    Raster<float> dem = rough_dem(frame(80, 80), 5);
    Geomorphons const one = geomorphons(dem);
    for (float& z : dem.values()) {
        z = -z;
    }
    Geomorphons const other = geomorphons(dem);
    auto const of = [](Geomorphons const& g, Form f) { return g.cells[static_cast<std::size_t>(f) - 1]; };
    EXPECT_EQ(of(one, Form::valley), of(other, Form::ridge));
    EXPECT_EQ(of(one, Form::peak), of(other, Form::pit));
    EXPECT_GT(of(one, Form::valley), 0);
}

TEST(Geomorphons, SameBytesForAnyThreads) {
    Raster<float> const dem = rough_dem(frame(300, 300), 11);
    thalweg::Run const one = on_threads(1);
    thalweg::Run const five = on_threads(5);
    Geomorphons const a = geomorphons(dem, {}, one);
    Geomorphons const b = geomorphons(dem, {}, five);
    EXPECT_TRUE(std::equal(a.form.values().begin(), a.form.values().end(), b.form.values().begin()));
    EXPECT_EQ(a.shares, b.shares);
}

} // namespace geomorphons_test
