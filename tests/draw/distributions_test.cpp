// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/distributions.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>

#include "pictures.hpp"

namespace distributions_test {

using namespace thalweg;
using draw::Distribution;
using draw::DistributionsParams;
using draw::Format;

namespace {

/// An index with the values 0, 1, ..., count - 1, divided by ten.
Distribution ramp(std::size_t count) {
    Distribution index;
    index.name = "Hack’s exponent h";
    for (std::size_t i = 0; i < count; ++i) {
        index.values.push_back(0.1 * static_cast<double>(i));
    }
    return index;
}

Distribution with_range(Distribution index, double low, double high) {
    index.low = low;
    index.high = high;
    return index;
}

test::Pixels pixels_of(std::vector<Distribution> const& indices) {
    return test::decode(draw::distributions(indices, {.title = {}, .note = {}, .format = Format::png}).bytes);
}

/// Pixels that are clearly orange: members outside their range.
std::size_t orange_pixels(test::Pixels const& pixels) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels.rgb.size(); i += 3) {
        count += pixels.rgb[i] > pixels.rgb[i + 2] + 120 ? 1 : 0;
    }
    return count;
}

} // namespace

TEST(Distributions, CountsAreThoseInsideTheRangeAndItsEnds) {
    draw::DistributionCounts const none = draw::counts_of(ramp(5));
    EXPECT_EQ(none.known, 5);
    EXPECT_FALSE(none.inside);
    Distribution index = with_range(ramp(5), 0.0, 0.2);
    index.values.push_back(NAN);
    draw::DistributionCounts const counts = draw::counts_of(index);
    EXPECT_EQ(counts.known, 5);
    EXPECT_EQ(counts.inside.value(), 3);
}

TEST(Distributions, OfNothingOfOneAndOfEqualValues) {
    Distribution zeros = with_range(ramp(1), 0.0, 0.0);
    zeros.values.assign(50, 0.0);
    Distribution unknown = ramp(1);
    unknown.values = {NAN, NAN};
    Distribution large = ramp(1);
    large.values = {1e300, -1e300, 5.0};
    Distribution alike = ramp(1);
    alike.values = {1e9, 1e9, 1e9};
    EXPECT_TRUE(test::is_xml(draw::distributions({}).bytes));
    EXPECT_TRUE(test::is_xml(draw::distributions({ramp(0), ramp(1), zeros, unknown, large, alike}).bytes));
    EXPECT_TRUE(test::is_xml(draw::responses(ramp(1), {ramp(1)}).bytes));
    EXPECT_TRUE(test::is_xml(draw::responses(ramp(1), {}).bytes));
    EXPECT_TRUE(test::is_xml(draw::responses(alike, {large, with_range(large, 2.0, 7.0)}).bytes));
}

TEST(Distributions, RefuseWhatDoesNotFit) {
    Distribution index = ramp(3);
    index.values[1] = std::numeric_limits<double>::infinity();
    EXPECT_THROW(draw::distributions({index}), BadInput);
    EXPECT_THROW(draw::distributions({with_range(ramp(3), 2.0, 1.0)}), BadInput);
    Distribution half = ramp(3);
    half.low = 1.0;
    EXPECT_THROW(draw::distributions({half}), BadInput);
    EXPECT_THROW(draw::responses(ramp(2), {ramp(3)}), BadInput);
    EXPECT_THROW(draw::distributions(std::vector<Distribution>(2000, ramp(1)), {.title = {}, .note = {}}), BadInput);
    EXPECT_THROW(draw::distributions({}, {.title = {}, .note = {}, .width_px = 100}), BadParameter);
}

TEST(Distributions, MembersOutsideTheRangeHaveAnotherColour) {
    for (std::size_t const members : {10U, 200U}) {
        double const end = 0.1 * static_cast<double>(members);
        std::size_t const none = orange_pixels(pixels_of({with_range(ramp(members), -1.0, end)}));
        std::size_t const half = orange_pixels(pixels_of({with_range(ramp(members), -1.0, 0.5 * end)}));
        std::size_t const all = orange_pixels(pixels_of({with_range(ramp(members), end, 2.0 * end)}));
        EXPECT_GT(half, none + 100) << members; // the legend has a sample
        EXPECT_GT(all, half + 100) << members;
    }
}

TEST(Distributions, TheSameBytesInEveryFormat) {
    Distribution first = with_range(ramp(100), 1.0, 3.0);
    first.group = "Rivers & <lakes>";
    first.unit = "km/km²";
    std::vector<Distribution> const indices = {first, ramp(100), ramp(100)};
    for (Format const format : {Format::svg, Format::png, Format::pdf}) {
        DistributionsParams const params{"谷 & <valley>", "100 members", 900, format};
        std::string const bytes = draw::distributions(indices, params).bytes;
        EXPECT_TRUE(bytes == draw::distributions(indices, params).bytes);
        draw::ResponsesParams const other{"谷 & <valley>", "100 members", 900, format};
        EXPECT_TRUE(draw::responses(indices[1], indices, other).bytes ==
                    draw::responses(indices[1], indices, other).bytes);
    }
    EXPECT_TRUE(test::is_xml(draw::distributions(indices, {"谷 & <valley>", "100 members"}).bytes));
    EXPECT_EQ(pixels_of(indices).width, 1400U);
}

TEST(Distributions, ResponsesShowSomeOfManyMembers) {
    std::size_t const some = draw::responses(ramp(500), {ramp(500)}).bytes.size();
    std::size_t const many = draw::responses(ramp(50000), {ramp(50000)}).bytes.size();
    EXPECT_LT(many, some + some / 5);
}

} // namespace distributions_test
