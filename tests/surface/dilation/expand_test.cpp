// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/dilation/dilation.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/surface/dilation/separable.hpp>

#include "valleys.hpp"

namespace expand_test {

using namespace thalweg;
using namespace thalweg::surface;

namespace {

using test::full_message_of;
using test::on_threads;
using test::same_bits;

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
        EXPECT_NE(text.find("column 8, row 1"), std::string::npos) << text;
    }
    EXPECT_THROW(expand_frontier(valley, Mask(test::frame_below(4, 9), 1)), BadInput);
}

TEST(Expand, OneCell) {
    Valley const valley{Raster<float>(test::frame_below(1, 1), -0.0F)};
    for (Expansion const& e : {expand(valley), frontier(valley)}) {
        EXPECT_EQ(e.level[0], 0);
        EXPECT_TRUE(std::signbit(e.base[0]));
    }
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

TEST(Frontier, GoesAroundWallsAndNotIntoPockets) {
    // R river, # barrier, . land; the pocket in the east is closed.
    std::string const map = "R.#...##."
                            ".##.#.#.#"
                            ".....##.#"
                            "####...##";
    Valley valley{Raster<float>(test::frame_below(9, 4), valleys::nan)};
    Mask inside(valley.z.grid(), 1);
    for (std::int64_t i = 0; i < inside.cells(); ++i) {
        char const c = map[static_cast<std::size_t>(i)];
        inside[i] = c == '#' ? 0 : 1;
        valley.z[i] = c == 'R' ? 5.0F : (i == 13 ? 1.0F : valleys::nan); // a river cell inside the wall does not count
    }
    std::vector<std::int32_t> const level = {0, 1, -1, 7, 8, 9,  -1, -1, -1, 1,  -1, -1, 6,  -1, 10, -1, -1, -1,
                                             2, 3, 4,  5, 6, -1, -1, -1, -1, -1, -1, -1, -1, 7,  8,  9,  -1, -1};
    Expansion const e = expand_frontier(valley, inside);
    for (std::int64_t i = 0; i < inside.cells(); ++i) {
        EXPECT_TRUE(e.level[i] < 0 ? std::isnan(e.base[i]) : e.base[i] == 5.0F);
    }
    EXPECT_EQ(std::vector<std::int32_t>(e.level.values().begin(), e.level.values().end()), level);
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

} // namespace

} // namespace expand_test
