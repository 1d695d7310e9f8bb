// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/vectorise.hpp>

#include <algorithm>

#include <gtest/gtest.h>
#include <network/masks.hpp>
#include <network/plain_thinning.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

namespace thin_test {

namespace {

using namespace thalweg;
using network::thin;

bool same(Mask const& a, Mask const& b) {
    return a.grid() == b.grid() && std::equal(a.values().begin(), a.values().end(), b.values().begin());
}

/// A mask of either kind, its width around the multiples of 64 and far from them.
Mask any_mask() {
    auto const seed = *rc::gen::arbitrary<std::uint64_t>();
    auto const width = *rc::gen::element<std::int64_t>(1, 2, 3, 17, 63, 64, 65, 127, 128, 130, 200);
    auto const height = *rc::gen::inRange<std::int64_t>(1, 40);
    if (*rc::gen::arbitrary<bool>()) {
        return test::random_mask(seed, width, height, *rc::gen::element(0.2, 0.5, 0.7, 0.9, 0.98));
    }
    return test::random_blob(seed, width, height, *rc::gen::inRange(1, 12), *rc::gen::inRange(1, 8));
}

} // namespace

TEST(Thin, EmptyAndFullAndSingle) {
    EXPECT_EQ(thin(Mask()).cells(), 0);
    EXPECT_TRUE(same(thin(Mask(test::frame(70, 3))), Mask(test::frame(70, 3))));
    EXPECT_TRUE(same(thin(Mask(test::frame(1, 1), 1)), Mask(test::frame(1, 1), 1)));
    EXPECT_EQ(test::components(thin(Mask(test::frame(130, 70), 1)), 1, 8), 1);
}

TEST(Thin, AnyValueButZeroIsInside) {
    Mask mask(test::frame(70, 9), 255);
    mask[Cell{3, 3}] = 128;
    EXPECT_TRUE(same(thin(mask), thin(Mask(test::frame(70, 9), 1))));
}

TEST(Thin, BlocksOfTwoByTwoDoNotVanish) {
    Mask const mask = test::mask_of({"##..##", "##..##", "......", "##....", "##...#"});
    EXPECT_EQ(test::rows_of(thin(mask)), (std::vector<std::string>{"......", "#...#.", "......", "......", "#....#"}));
}

TEST(Thin, StaircasesLoseTheirCorners) {
    EXPECT_EQ(test::rows_of(thin(test::mask_of({"##...", ".##..", "..##.", "...##"}))),
              (std::vector<std::string>{"#....", ".#...", "..#..", "...##"}));
}

TEST(Thin, AcrossTheSeamOfTwoWords) {
    Mask mask(test::frame(128, 5));
    for (std::int64_t col = 50; col < 80; ++col) {
        for (std::int64_t row = 1; row < 4; ++row) {
            mask[Cell{col, row}] = 1;
        }
    }
    Mask const skeleton = thin(mask);
    for (std::int64_t col = 52; col < 78; ++col) {
        EXPECT_EQ((skeleton[Cell{col, 1}]), 0) << col;
        EXPECT_EQ((skeleton[Cell{col, 2}]), 1) << col;
        EXPECT_EQ((skeleton[Cell{col, 3}]), 0) << col;
    }
}

TEST(Thin, EqualsGuoHallCellByCell) {
    ASSERT_TRUE(rc::check("64 cells a word = cell by cell", [] {
        Mask const mask = any_mask();
        Mask const skeleton = thin(mask);
        RC_ASSERT(same(skeleton, test::plain_thin(mask)));
        RC_ASSERT(same(skeleton, test::table_thin(mask)));
    }));
}

TEST(Thin, KeepsComponentsAndHolesAndIsIdempotent) {
    ASSERT_TRUE(rc::check("subset, topology, idempotent", [] {
        Mask const mask = any_mask();
        Mask const skeleton = thin(mask);
        for (std::int64_t i = 0; i < mask.cells(); ++i) {
            RC_ASSERT(skeleton[i] <= mask[i]);
        }
        RC_ASSERT(test::components(skeleton, 1, 8) == test::components(mask, 1, 8));
        RC_ASSERT(test::components(skeleton, 0, 4) == test::components(mask, 0, 4));
        RC_ASSERT(same(thin(skeleton), skeleton));
    }));
}

TEST(Thin, OneCellWide) {
    ASSERT_TRUE(rc::check("no cell with a full 3 x 3 or 2 x 3 block, no L-corner that could go", [] {
        Mask const skeleton = thin(any_mask());
        for (std::int64_t i = 0; i < skeleton.cells(); ++i) {
            if (skeleton[i] != 0) {
                auto const p = test::guo_hall_neighbours(skeleton, skeleton.grid().at(i));
                RC_ASSERT((!test::guo_hall_deletes(p, 0) && !test::guo_hall_deletes(p, 1)));
                // Two orthogonal neighbours round a corner and nothing else: the diagonal does as well.
                for (std::size_t k = 2; k <= 8; k += 2) {
                    std::size_t const next = k == 8 ? 2 : k + 2;
                    int others = 0;
                    for (std::size_t q = 2; q < 10; ++q) {
                        others += q != k && q != next ? p[q] : 0;
                    }
                    RC_ASSERT(!(p[k] != 0 && p[next] != 0 && others == 0));
                }
            }
        }
    }));
}

TEST(Thin, Stops) {
    std::stop_source source;
    source.request_stop();
    thalweg::Run run;
    run.stop = source.get_token();
    EXPECT_THROW(thin(Mask(test::frame(8, 8), 1), run), Cancelled);
}

} // namespace thin_test
