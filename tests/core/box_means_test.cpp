// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/box_means.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include <support.hpp>

namespace box_means_test {

using namespace thalweg;

namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// The length that two intervals share.
double shared(double a, double b, double c, double d) {
    return std::max(0.0, std::min(b, d) - std::max(a, c));
}

/// The mean of every coarse cell, from the definition.
Raster<float> means_slowly(Raster<float> const& fine, std::int64_t columns) {
    double const side = static_cast<double>(fine.width()) / static_cast<double>(columns);
    Raster<float> out(coarser(fine.grid(), columns));
    for (std::int64_t i = 0; i < out.cells(); ++i) {
        Cell const c = out.grid().at(i);
        double sum = 0.0;
        double weight = 0.0;
        double area = 0.0;
        for (std::int64_t k = 0; k < fine.cells(); ++k) {
            Cell const f = fine.grid().at(k);
            auto const [col, row] = std::pair(static_cast<double>(f.col), static_cast<double>(f.row));
            auto const [west, north] = std::pair(static_cast<double>(c.col) * side, static_cast<double>(c.row) * side);
            double const share =
                shared(col, col + 1.0, west, west + side) * shared(row, row + 1.0, north, north + side);
            area += share;
            weight += std::isnan(fine[k]) ? 0.0 : share;
            sum += std::isnan(fine[k]) ? 0.0 : share * static_cast<double>(fine[k]);
        }
        out[i] = weight >= 0.5 * area - 1e-9 ? static_cast<float>(sum / weight) : none;
    }
    return out;
}

/// A rough land, with holes unless it is to be whole.
Raster<float> rough(std::int64_t width, std::int64_t height, bool is_whole = false) {
    Raster<float> dem(Grid{width, height, 10.0, 100.0, 900.0, ""});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = !is_whole && (i * 37 + 11) % 23 < 6 ? none : static_cast<float>((i * 7919) % 101);
    }
    return dem;
}

} // namespace

TEST(BoxMeans, AreTheMeansOfWhatTheCoarseCellsCover) {
    using Size = std::tuple<std::int64_t, std::int64_t, bool>;
    for (auto const& [width, height, is_whole] :
         {Size{1, 1, false}, {7, 5, false}, {16, 9, false}, {9, 16, false}, {16, 9, true}, {9, 16, true}}) {
        Raster<float> const fine = rough(width, height, is_whole);
        for (std::int64_t columns = 1; columns <= width; ++columns) {
            Raster<float> const means = box_means(fine, columns);
            Raster<float> const slow = means_slowly(fine, columns);
            ASSERT_EQ(means.grid(), slow.grid());
            EXPECT_NEAR(means.grid().east(), fine.grid().east(), 1e-9);
            EXPECT_LE(means.grid().south(), fine.grid().south() + 1e-3);
            for (std::int64_t i = 0; i < means.cells(); ++i) {
                EXPECT_EQ(std::isnan(means[i]), std::isnan(slow[i])) << width << " to " << columns << ", cell " << i;
                if (!std::isnan(slow[i])) {
                    EXPECT_NEAR(means[i], slow[i], 1e-4) << width << " to " << columns << ", cell " << i;
                }
            }
        }
    }
}

TEST(BoxMeans, OfAsManyColumnsAreTheRasterItself) {
    Raster<float> const fine = rough(13, 40);
    Raster<float> const same = box_means(fine, 13);
    ASSERT_EQ(same.grid(), fine.grid());
    EXPECT_EQ(std::memcmp(same.values().data(), fine.values().data(), sizeof(float) * fine.values().size()), 0);
}

TEST(BoxMeans, DoNotDependOnThreads) {
    Raster<float> const fine = rough(300, 411);
    thalweg::Run many;
    many.threads = 5;
    thalweg::Run one;
    one.threads = 1;
    Raster<float> const a = box_means(fine, 97, many);
    Raster<float> const b = box_means(fine, 97, one);
    EXPECT_EQ(std::memcmp(a.values().data(), b.values().data(), sizeof(float) * a.values().size()), 0);
}

TEST(BoxMeans, OfAMaskMarkWhatIsMarkedByHalf) {
    Mask fine(Grid{4, 2, 1.0, 0.0, 2.0, ""});
    fine[Cell{0, 0}] = fine[Cell{1, 1}] = fine[Cell{2, 0}] = 1;
    Mask const half = box_means(fine, 2);
    ASSERT_EQ(half.cells(), 2);
    EXPECT_EQ(half[0], 1);
    EXPECT_EQ(half[1], 0);
}

TEST(BoxMeans, MarksKeepThinLines) {
    Mask fine(Grid{10, 7, 1.0, 0.0, 7.0, ""});
    for (std::int64_t row = 0; row < 7; ++row) {
        fine[Cell{4, row}] = 1;
    }
    Mask const marks = box_marks(fine, 4); // a cell is 2.5 wide, and column 4 ends at 5
    ASSERT_EQ(marks.height(), 3);
    for (std::int64_t i = 0; i < marks.cells(); ++i) {
        EXPECT_EQ(marks[i], marks.grid().at(i).col == 1 ? 1 : 0) << i;
    }
}

TEST(BlockMaxima, AreTheHighestOfEachBlock) {
    Raster<float> const fine = rough(11, 7);
    Raster<float> const maxima = block_maxima(fine, 3);
    ASSERT_EQ(maxima.width(), 4);
    ASSERT_EQ(maxima.height(), 3);
    for (std::int64_t i = 0; i < maxima.cells(); ++i) {
        Cell const c = maxima.grid().at(i);
        float highest = none;
        for (std::int64_t k = 0; k < fine.cells(); ++k) {
            Cell const f = fine.grid().at(k);
            if (f.col / 3 == c.col && f.row / 3 == c.row && !std::isnan(fine[k])) {
                highest = std::isnan(highest) ? fine[k] : std::max(highest, fine[k]);
            }
        }
        EXPECT_EQ(std::isnan(maxima[i]), std::isnan(highest));
        if (!std::isnan(highest)) {
            EXPECT_EQ(maxima[i], highest);
        }
    }
    EXPECT_TRUE(std::isnan(block_maxima(Raster<float>(Grid{2, 2, 1.0, 0.0, 2.0, ""}, none), 2)[0]));
}

TEST(Overview, HasTheBitsOfMeansAndMaximaFoundAlone) {
    thalweg::Run many;
    many.threads = 3;
    thalweg::Run one;
    one.threads = 1;
    auto const is_same = [](Raster<float> const& a, Raster<float> const& b) {
        return a.grid() == b.grid() &&
               std::memcmp(a.values().data(), b.values().data(), sizeof(float) * a.values().size()) == 0;
    };
    constexpr float infinite = std::numeric_limits<float>::infinity();
    // The widest has several bands; some have holes, and one has heights that are none.
    for (auto const& [width, height, is_whole] : {std::tuple<std::int64_t, std::int64_t, bool>{1, 1, true},
                                                  {9, 16, false},
                                                  {16, 9, true},
                                                  {130, 77, false},
                                                  {5000, 90, true}}) {
        Raster<float> fine = rough(width, height, is_whole);
        fine[fine.cells() / 2] = width == 130 ? -infinite : fine[fine.cells() / 2];
        fine[fine.cells() / 3] = width == 130 ? infinite : fine[fine.cells() / 3];
        std::optional<std::pair<double, double>> range;
        for (float const z : fine.values()) {
            if (std::isfinite(z)) {
                auto const m = static_cast<double>(z);
                range = range ? std::pair(std::min(range->first, m), std::max(range->second, m)) : std::pair(m, m);
            }
        }
        for (std::int64_t const columns : {std::max<std::int64_t>(1, width / 3), width, 3 * width}) {
            for (std::int64_t const side : {1, 2, 5}) {
                for (thalweg::Run const& run : {many, one}) {
                    Overview const found = overview(fine, columns, side, run);
                    EXPECT_EQ(found.range, range) << width;
                    EXPECT_TRUE(columns < width ? is_same(found.means, box_means(fine, columns))
                                                : found.means.cells() == 0)
                        << width << " to " << columns;
                    EXPECT_TRUE(side > 1 ? is_same(found.maxima, block_maxima(fine, side)) : found.maxima.cells() == 0)
                        << width << " by " << side;
                }
            }
        }
    }
}

TEST(Overview, OfNoHeightsHasNoRange) {
    EXPECT_FALSE(overview(Raster<float>(), 1, 1).range);
    Overview const found = overview(Raster<float>(Grid{4, 3, 1.0, 0.0, 3.0, ""}, none), 2, 2);
    EXPECT_FALSE(found.range);
    EXPECT_TRUE(std::isnan(found.means[0]));
    EXPECT_TRUE(std::isnan(found.maxima[0]));
}

} // namespace box_means_test
