// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/dilation/dilation.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <golden.hpp>
#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/surface/dilation/separable.hpp>

#include "valleys.hpp"

namespace dilation_test {

using namespace thalweg;
using namespace thalweg::surface;

namespace {

using test::full_message_of;
using test::on_threads;
using test::same_bits;

DilateParams with(std::string const& increment, Metric metric = Metric::cityblock, double relief_m = 0.0) {
    return {{increment}, metric, relief_m};
}

/// One river cell of height z at the west end of a row of land.
Valley ditch(std::int64_t width, float z, double cell_m = 1.0) {
    Valley valley{Raster<float>(test::frame_below(width, 1, cell_m), valleys::nan)};
    valley.z[0] = z;
    return valley;
}

/// As documented, cell by cell.
double flats(Valley const& valley, Raster<float> const& dem) {
    Grid const& grid = dem.grid();
    double dry = 0.0;
    double flat = 0.0;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (std::isnan(dem[i]) || !std::isnan(valley.z[i])) {
            continue;
        }
        Cell const c = grid.at(i);
        bool drained = false;
        for (Cell const near : {Cell{c.col - 1, c.row}, {c.col + 1, c.row}, {c.col, c.row - 1}, {c.col, c.row + 1}}) {
            drained = drained || (grid.contains(near) && dem[near] < dem[i]);
        }
        dry += 1.0;
        flat += drained ? 0.0 : 1.0;
    }
    return dry > 0.0 ? flat / dry : 0.0;
}

std::string as_text(DilatedDem const& d) {
    std::string text;
    char number[32];
    for (std::int64_t row = 0; row < d.dem.height(); ++row) {
        for (float const z : d.dem.row(row)) {
            std::snprintf(number, sizeof number, "%s%.9g", text.empty() || text.back() == '\n' ? "" : " ",
                          static_cast<double>(z));
            text += std::isnan(z) ? std::string(number, number[0] == ' ' ? 1 : 0) + "-" : number;
        }
        text += '\n';
    }
    return text;
}

/// A river of three arms that rises by a quarter a cell away from its mouth in the south.
Valley fork() {
    std::string const map = ".#........#...."
                            "..#......#....."
                            "...#....#......"
                            "....#..#......."
                            ".....##........"
                            ".....#........."
                            "....#.........."
                            "....#.........."
                            "....#..........";
    Valley valley{Raster<float>(test::frame_below(15, 9), valleys::nan)};
    for (std::int64_t i = 0; i < valley.z.cells(); ++i) {
        if (map[static_cast<std::size_t>(i)] == '#') {
            valley.z[i] = 0.25F * static_cast<float>(8 - valley.z.grid().at(i).row);
        }
    }
    return valley;
}

Expansion frontier(Valley const& valley) {
    return expand_frontier(valley, Mask(valley.z.grid(), 1));
}

bool same(Expansion const& a, Expansion const& b) {
    return same_bits(a.level, b.level) && same_bits(a.base, b.base);
}

template <class Level> Expansion by_lanes(Valley const& valley, Lanes lanes, int threads) {
    Run const run = on_threads(threads);
    Expansion expansion{Raster<std::int32_t>(valley.z.grid()), Raster<float>(valley.z.grid())};
    auto const swept = separable::sweep_down<Level>(valley, expansion.base, lanes, run);
    separable::sweep_up(swept, expansion.base, expansion.level, lanes, run);
    auto const most = *std::max_element(expansion.level.values().begin(), expansion.level.values().end());
    EXPECT_EQ(swept.levels, most);
    return expansion;
}

Valley one_river(Grid const& grid) {
    Valley valley{Raster<float>(grid, std::nanf(""))};
    for (std::int64_t row = 0; row < grid.height; ++row) {
        valley.z[Cell{grid.width / 2, row}] = static_cast<float>(grid.height - row);
    }
    return valley;
}

DilateParams even_slopes() {
    DilateParams params;
    params.increment.increment = "uniform";
    return params;
}

} // namespace

TEST(Dilate, RefusesWhatCannotBeDilated) {
    for (Metric const metric : {Metric::cityblock, Metric::euclid}) {
        EXPECT_THROW(dilate(Valley{}, with("uniform", metric)), BadInput);
        Valley dry{Raster<float>(test::frame_below(5, 5), valleys::nan)};
        EXPECT_THROW(dilate(dry, with("uniform", metric)), BadInput);
        dry.z[{3, 1}] = std::numeric_limits<float>::infinity();
        auto const text = full_message_of<BadInput>([&] { dilate(dry, with("uniform", metric)); });
        EXPECT_TRUE(test::has(text, "column 3, row 1"));
        Valley const outside = ditch(3, 1.0F);
        EXPECT_THROW(dilate(outside, Mask(outside.z.grid(), 0), with("uniform", metric)), BadInput);
        EXPECT_THROW(dilate(outside, Mask(test::frame_below(1, 3), 1), with("uniform", metric)), BadInput);
        EXPECT_THROW(dilate(ditch(3, 1.0F, 0.0), with("uniform", metric)), BadInput);
        EXPECT_THROW(dilate(ditch(3, 1.0F), with("unifrm", metric)), BadParameter);
        EXPECT_THROW(dilate(ditch(3, 1.0F), with("1/(x-2)", metric)), BadParameter);
        EXPECT_THROW(dilate(ditch(3, 1.0F), with("1e300*x", metric)), BadParameter);
        EXPECT_THROW(dilate(ditch(3, 1.0F), with("uniform", metric, -1.0)), BadParameter);
        EXPECT_THROW(dilate(ditch(3, 1.0F), with("uniform", metric, std::nan(""))), BadParameter);
        EXPECT_THROW(dilate(ditch(3, 1.0F), with("0*x", metric, 10.0)), BadParameter);
    }
}

TEST(Dilate, AllRiver) {
    Valley const valley{Raster<float>(test::frame_below(3, 2), -0.0F)};
    for (Metric const metric : {Metric::cityblock, Metric::euclid}) {
        DilatedDem const d = dilate(valley, with("rise_fall", metric, 100.0));
        EXPECT_TRUE(same_bits(d.dem, valley.z));
        EXPECT_EQ(d.levels, 0);
        EXPECT_TRUE(d.increments.empty());
        EXPECT_EQ(d.flat_share, 0.0);
    }
}

TEST(Dilate, PapersUnitsCountInCells) {
    DilatedDem const d = dilate(ditch(4, 7.0F, 30.0), with("decreasing"));
    ASSERT_EQ(d.levels, 3);
    EXPECT_NEAR(d.increments[2], 30.0 * 2.97, 1e-12);
    EXPECT_FLOAT_EQ(d.dem[3], static_cast<float>(7.0 + 30.0 * (2.99 + 2.98 + 2.97)));
}

TEST(Dilate, HeightsOfTable1) {
    EXPECT_EQ(dilate(ditch(701, 1.0F), with("decreasing")).dem[300], 449.5F);
    EXPECT_EQ(dilate(ditch(701, 1.0F), with("rise_fall")).dem[150], 340.75F);
    EXPECT_EQ(dilate(ditch(701, 1.0F), with("rise_fall")).dem[700], 1351.0F);
    DilateParams falling = with("rise_fall");
    falling.increment.allow_negative = true;
    EXPECT_EQ(dilate(ditch(701, 1.0F), falling).dem[700], 1300.5F);
}

TEST(Dilate, IsTheLiteralLoopOfThePaper) {
    ASSERT_TRUE(rc::check("E = base + H(level) is what the scan of the whole grid makes", [] {
        Valley const valley = valleys::any(20);
        bool const walled = *rc::gen::element(false, true).as("walled");
        Mask const inside = walled ? valleys::barriers(valley, 0.35, 3) : Mask(valley.z.grid(), 1);
        Expansion const e = walled ? expand_frontier(valley, inside) : expand(valley);
        for (char const* const name : {"uniform", "decreasing", "rise_fall"}) {
            auto const dh = increments(valley.z.cells(), {name});
            auto const sums = heights_above_valley(dh);
            auto const literal = valleys::literal_dilation(valley, inside, dh);
            DilatedDem const d = dilate(valley, inside, with(name));
            for (std::int64_t i = 0; i < valley.z.cells(); ++i) {
                double const expected = literal[static_cast<std::size_t>(i)];
                RC_ASSERT(std::isnan(expected) == (e.level[i] < 0));
                RC_ASSERT(std::isnan(expected) == std::isnan(d.dem[i]));
                if (e.level[i] >= 0) {
                    double const closed = static_cast<double>(e.base[i]) + sums[static_cast<std::size_t>(e.level[i])];
                    RC_ASSERT(std::fabs(closed - expected) <= 1e-12);
                    RC_ASSERT(d.dem[i] == static_cast<float>(closed));
                }
            }
        }
    }));
}

TEST(Dilate, KeepsTheValleyToTheBit) {
    ASSERT_TRUE(rc::check("valley cells exact", [] {
        Valley const valley = valleys::any(30);
        for (Metric const metric : {Metric::cityblock, Metric::euclid}) {
            for (std::string const& increment : {"uniform", "0*x"}) {
                DilatedDem const d = dilate(valley, with(increment, metric));
                for (std::int64_t i = 0; i < valley.z.cells(); ++i) {
                    RC_ASSERT(!std::isnan(d.dem[i]));
                    RC_ASSERT((std::isnan(valley.z[i]) ||
                               std::bit_cast<std::uint32_t>(valley.z[i]) == std::bit_cast<std::uint32_t>(d.dem[i])));
                }
            }
        }
    }));
}

TEST(Dilate, ThreadsChangeNoByte) {
    Valley const valley = valleys::by_chance(1030, 777, 0.001, 8);
    Mask const inside = valleys::barriers(valley, 0.1, 2);
    for (Metric const metric : {Metric::cityblock, Metric::euclid}) {
        for (double const relief_m : {0.0, 300.0}) {
            DilateParams const params = with("rise_fall", metric, relief_m);
            DilatedDem const one = dilate(valley, params, on_threads(1));
            DilatedDem const two = dilate(valley, params, on_threads(2));
            EXPECT_TRUE(same_bits(one.dem, two.dem));
            EXPECT_EQ(one.increments, two.increments);
            EXPECT_EQ(one.flat_share, two.flat_share);
            EXPECT_TRUE(same_bits(dilate(valley, inside, params, on_threads(1)).dem,
                                  dilate(valley, inside, params, on_threads(2)).dem));
        }
    }
}

TEST(Dilate, AnOpenMaskChangesNoByte) {
    Valley const valley = valleys::by_chance(40, 33, 0.02, 11);
    for (Metric const metric : {Metric::cityblock, Metric::euclid}) {
        DilatedDem const open = dilate(valley, with("rise_fall", metric));
        DilatedDem const masked = dilate(valley, Mask(valley.z.grid(), 7), with("rise_fall", metric));
        EXPECT_TRUE(same_bits(open.dem, masked.dem));
    }
}

TEST(Dilate, ReachesTheReliefAskedFor) {
    ASSERT_TRUE(rc::check("greatest sum of increments on the grid = relief", [] {
        Valley valley = valleys::any(25);
        for (float& z : valley.z.values()) {
            z = std::isnan(z) ? z : 0.0F;
        }
        bool const walled = *rc::gen::element(false, true).as("walled");
        Mask const inside = walled ? valleys::barriers(valley, 0.3, 9) : Mask(valley.z.grid(), 1);
        Metric const metric = *rc::gen::element(Metric::cityblock, Metric::euclid).as("metric");
        std::string const increment = *rc::gen::element<std::string>("rise_fall", "decreasing", "4-x").as("increment");
        double const relief_m = *rc::gen::element(0.0, 250.0).as("relief");
        DilateParams params = with(increment, metric, relief_m);
        params.increment.allow_negative = true;
        DilatedDem const d = dilate(valley, inside, params);
        RC_ASSERT(static_cast<std::int64_t>(d.increments.size()) == d.levels);
        float highest = 0.0F;
        for (float const z : d.dem.values()) {
            highest = z > highest ? z : highest;
        }
        RC_ASSERT(std::fabs(static_cast<double>(highest) - d.rise_m) <= 1e-6 * d.rise_m);
        if (relief_m > 0.0) {
            RC_ASSERT(highest == (d.levels > 0 ? 250.0F : 0.0F));
        }
    }));
}

TEST(Dilate, CountsFlats) {
    EXPECT_EQ(dilate(ditch(11, 0.0F), with("x<6 ? 1 : 0")).flat_share, 0.5);
    EXPECT_EQ(dilate(ditch(11, 0.0F), with("0.5")).flat_share, 0.0);
    EXPECT_EQ(dilate(ditch(11, 3e7F), with("0.5")).flat_share, 0.8); // floats lie 2 m apart there: two steps in 5 m
    ASSERT_TRUE(rc::check("flat_share is the share counted cell by cell", [] {
        Valley const valley = valleys::any(25);
        Mask const inside = valleys::barriers(valley, *rc::gen::element(0.0, 0.3).as("walls"), 4);
        Valley within = valley;
        for (std::int64_t i = 0; i < inside.cells(); ++i) {
            within.z[i] = inside[i] == 0 ? valleys::nan : valley.z[i];
        }
        std::string const increment =
            *rc::gen::element<std::string>("uniform", "x<4 ? 1 : 0", "1e-7", "2-x").as("increment");
        for (Metric const metric : {Metric::cityblock, Metric::euclid}) {
            DilateParams params = with(increment, metric);
            params.increment.allow_negative = true;
            DilatedDem const d = dilate(valley, inside, params);
            RC_ASSERT(d.flat_share == flats(within, d.dem));
        }
    }));
}

TEST(DilateEuclid, IsTheNearestOfAllValleyCells) {
    ASSERT_TRUE(rc::check("E = e of the nearest valley cell, lowest index on ties, + H(distance)", [] {
        Valley const valley = valleys::any(18);
        Grid const& grid = valley.z.grid();
        Mask const inside = valleys::barriers(valley, *rc::gen::element(0.0, 0.3).as("walls"), 6);
        DilatedDem const d = dilate(valley, inside, with("rise_fall", Metric::euclid));
        auto const dh = increments(100, {"rise_fall"});
        auto const sums = heights_above_valley(dh);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (inside[i] == 0) {
                RC_ASSERT(std::isnan(d.dem[i]));
                continue;
            }
            std::int64_t least = 1 << 30;
            std::int64_t nearest = -1;
            for (std::int64_t v = 0; v < grid.cells(); ++v) {
                std::int64_t const dx = grid.at(i).col - grid.at(v).col;
                std::int64_t const dy = grid.at(i).row - grid.at(v).row;
                if (inside[v] != 0 && !std::isnan(valley.z[v]) && dx * dx + dy * dy < least) {
                    least = dx * dx + dy * dy;
                    nearest = v;
                }
            }
            double const r = std::sqrt(static_cast<double>(least));
            auto const k = static_cast<std::size_t>(r);
            double const above = sums[k] + (r - std::floor(r)) * dh[k];
            RC_ASSERT(d.dem[i] == static_cast<float>(static_cast<double>(valley.z[nearest]) + above));
        }
    }));
}

TEST(DilateGolden, Fork) {
    expect_golden("dilate_fork.txt", as_text(dilate(fork(), with("decreasing"))));
}

TEST(DilateGolden, ForkWithALake) {
    Mask lake(fork().z.grid(), 1);
    for (std::int64_t row = 2; row < 6; ++row) {
        for (std::int64_t col = 10; col < 13; ++col) {
            lake[{col, row}] = 0;
        }
    }
    expect_golden("dilate_fork_lake.txt", as_text(dilate(fork(), lake, with("rise_fall", Metric::cityblock, 40.0))));
}

TEST(DilateGolden, ForkRound) {
    expect_golden("dilate_fork_euclid.txt", as_text(dilate(fork(), with("uniform", Metric::euclid, 40.0))));
}

TEST(Expand, RefusesWhatIsNoValley) {
    Valley const none;
    EXPECT_THROW(expand(none), BadInput);
    EXPECT_THROW(expand_frontier(none, Mask()), BadInput);
    Valley valley{Raster<float>(test::frame_below(9, 4), valleys::nan)};
    EXPECT_THROW(expand(valley), BadInput);
    EXPECT_THROW(frontier(valley), BadInput);
    valley.z[{2, 3}] = 1.0F;
    valley.z[{8, 1}] = -std::numeric_limits<float>::infinity();
    for (auto const& verb :
         {+[](Valley const& v) { return expand(v); }, +[](Valley const& v) { return frontier(v); }}) {
        auto const text = full_message_of<BadInput>([&] { verb(valley); });
        EXPECT_TRUE(test::has(text, "column 8, row 1"));
    }
    EXPECT_THROW(expand_frontier(valley, Mask(test::frame_below(4, 9), 1)), BadInput);
}

TEST(Expand, LongLines) {
    for (auto const& grid : {test::frame_below(70000, 1), test::frame_below(1, 70000), test::frame_below(65534, 1)}) {
        Valley valley{Raster<float>(grid, valleys::nan)};
        valley.z[0] = 3.0F;
        EXPECT_TRUE(same(expand(valley), frontier(valley)));
        EXPECT_EQ(expand(valley).level[grid.cells() - 1], grid.cells() - 1);
    }
}

TEST(Expand, AllNaNsMeanNoRiver) {
    Valley plain{Raster<float>(test::frame_below(11, 3), valleys::nan)};
    plain.z[5] = 2.0F;
    Valley odd = plain;
    for (float& z : odd.z.values()) {
        z = std::isnan(z) ? std::bit_cast<float>(0xffc12345U) : z;
    }
    EXPECT_TRUE(same(expand(plain), expand(odd)));
    EXPECT_TRUE(same(frontier(plain), frontier(odd)));
}

TEST(Expand, IsTheLeastOfTheNearestValleyCells) {
    ASSERT_TRUE(rc::check("base = min{e_v : |c - v| = d(c)}", [] {
        Valley const valley = valleys::any(14);
        Expansion const e = expand(valley);
        Grid const& grid = valley.z.grid();
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            std::int64_t level = grid.cells();
            float base = 0.0F;
            for (std::int64_t v = 0; v < grid.cells(); ++v) {
                std::int64_t const d =
                    std::abs(grid.at(i).col - grid.at(v).col) + std::abs(grid.at(i).row - grid.at(v).row);
                if (!std::isnan(valley.z[v]) && (d < level || (d == level && valley.z[v] < base))) {
                    level = d;
                    base = valley.z[v];
                }
            }
            RC_ASSERT(e.level[i] == level);
            RC_ASSERT(e.base[i] == base);
        }
    }));
}

TEST(Expand, ClosedFormIsTheFrontierBitForBit) {
    ASSERT_TRUE(rc::check("expand == expand_frontier", [] {
        Valley const valley = valleys::any(70);
        RC_ASSERT(same(expand(valley), frontier(valley)));
    }));
}

TEST(Expand, TheSameBytesFromEveryWayToRunIt) {
    ASSERT_TRUE(rc::check("lanes, widths of level and threads change no byte", [] {
        Valley const valley = valleys::any(70);
        Expansion const reference = frontier(valley);
        Lanes const widest = widest_lanes();
        for (int const threads : {1, 2, 5}) {
            RC_ASSERT(same(reference, by_lanes<std::uint16_t>(valley, Lanes::plain, threads)));
            RC_ASSERT(same(reference, by_lanes<std::int32_t>(valley, Lanes::plain, threads)));
            RC_ASSERT(same(reference, by_lanes<std::uint16_t>(valley, widest, threads)));
            RC_ASSERT(same(reference, by_lanes<std::int32_t>(valley, widest, threads)));
        }
    }));
}

TEST(Expand, StripsAndBandsOfALargeGrid) {
    Valley const valley = valleys::by_chance(1111, 1203, 0.0004, 5);
    Expansion const reference = frontier(valley);
    for (int const threads : {1, 2, 7}) {
        EXPECT_TRUE(same(reference, by_lanes<std::uint16_t>(valley, Lanes::plain, threads)));
        EXPECT_TRUE(same(reference, by_lanes<std::uint16_t>(valley, widest_lanes(), threads)));
    }
}

TEST(Frontier, Cancelled) {
    std::stop_source source;
    source.request_stop();
    thalweg::Run run;
    run.stop = source.get_token();
    Valley const valley = valleys::by_chance(20, 20, 0.1, 1);
    EXPECT_THROW(expand_frontier(valley, Mask(valley.z.grid(), 1), run), Cancelled);
    EXPECT_THROW(expand(valley, run), Cancelled);
    EXPECT_THROW(dilate(valley, {}, run), Cancelled);
}

TEST(DilateOver, RefusesABaseOfAnotherFrame) {
    Valley const valley = one_river(test::frame_below(5, 5));
    EXPECT_THROW(dilate_over(valley, Raster<float>(test::frame_below(5, 6))), BadInput);
}

TEST(DilateOver, HasNoHeightWhereTheBaseHasNone) {
    Valley const valley = one_river(test::frame_below(5, 5));
    Raster<float> base(valley.z.grid(), 1.0F);
    base[Cell{0, 3}] = std::nanf("");
    EXPECT_TRUE(std::isnan(dilate_over(valley, base).dem[Cell{0, 3}]));
}

TEST(DilateOver, RisesFromTheBaseAsADilationRisesFromLevelGround) {
    Grid const grid = test::frame_below(9, 7);
    Valley const valley = one_river(grid);
    Valley level = valley;
    for (float& z : level.z.values()) {
        z = std::isnan(z) ? z : 0.0F;
    }
    Raster<float> base(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        base[i] = static_cast<float>(i % 5) * 3.0F;
    }
    DilatedDem const rise = dilate(level, even_slopes());
    DilatedDem const land = dilate_over(valley, base, even_slopes());
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        EXPECT_EQ(land.dem[i], std::isnan(valley.z[i]) ? base[i] + rise.dem[i] : valley.z[i]);
    }
    EXPECT_EQ(land.levels, rise.levels);
}

TEST(DilateOver, CellsBehindABarrierStayWithout) {
    Grid const grid = test::frame_below(9, 7);
    Valley const valley = one_river(grid);
    Mask inside(grid, 1);
    for (std::int64_t row = 0; row < grid.height; ++row) {
        inside[Cell{2, row}] = 0;
    }
    DilatedDem const land = dilate_over(valley, Raster<float>(grid, 5.0F), inside, even_slopes());
    EXPECT_TRUE(std::isnan(land.dem[Cell{0, 3}]));
    EXPECT_TRUE(std::isnan(land.dem[Cell{2, 3}]));
    EXPECT_FALSE(std::isnan(land.dem[Cell{3, 3}]));
}

} // namespace dilation_test
