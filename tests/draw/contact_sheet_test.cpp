// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/contact_sheet.hpp>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>

#include "pictures.hpp"

namespace contact_sheet_test {

using namespace thalweg;
using draw::Thumbnail;

namespace {

Thumbnail of_light(std::int64_t width, std::int64_t height, std::uint8_t light) {
    Grid grid;
    grid.width = width;
    grid.height = height;
    Thumbnail one{Raster<std::uint8_t>(grid), "", {"0 · seed 7", "surface.mean_slope 12"}};
    std::fill(one.shade.values().begin(), one.shade.values().end(), light);
    return one;
}

std::size_t pixels_of_grey(test::Pixels const& pixels, unsigned char grey) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels.rgb.size(); i += 3) {
        count += pixels.rgb[i] == grey && pixels.rgb[i + 1] == grey && pixels.rgb[i + 2] == grey ? 1 : 0;
    }
    return count;
}

} // namespace

TEST(ContactSheet, OfNothingAndOfMembersWithoutTerrain) {
    EXPECT_FALSE(test::decode(draw::contact_sheet({}).bytes).rgb.empty());
    EXPECT_FALSE(test::decode(draw::contact_sheet({{{}, "failed", {"3"}}, {{}, "", {}}}).bytes).rgb.empty());
    EXPECT_THROW(draw::contact_sheet({}, {.title = {}, .note = {}, .width_px = 10}), BadParameter);
    EXPECT_THROW(draw::contact_sheet(std::vector<Thumbnail>(5000)), BadInput);
}

TEST(ContactSheet, EveryTerrainHasItsShapeInOneFrame) {
    draw::ContactSheetParams const params{"谷 & <valley>", "all 3 members", 800, draw::Format::png};
    std::vector<Thumbnail> const sheet = {of_light(40, 40, 100), of_light(40, 20, 150), of_light(20, 40, 200)};
    std::string const bytes = draw::contact_sheet(sheet, params).bytes;
    EXPECT_TRUE(bytes == draw::contact_sheet(sheet, params).bytes);
    test::Pixels const pixels = test::decode(bytes);
    EXPECT_EQ(pixels.width, 800U);
    auto const area = static_cast<double>(pixels_of_grey(pixels, 100));
    EXPECT_GT(area, 4000.0); // of a fourth of the sheet's width, and twice as high as wide
    EXPECT_NEAR(static_cast<double>(pixels_of_grey(pixels, 150)) / area, 0.5, 0.05);
    EXPECT_NEAR(static_cast<double>(pixels_of_grey(pixels, 200)) / area, 2.0, 0.15);
}

TEST(ContactSheet, InEveryFormat) {
    draw::ContactSheetParams params;
    params.format = draw::Format::svg;
    EXPECT_TRUE(test::is_xml(draw::contact_sheet({of_light(5, 4, 90)}, params).bytes));
    params.format = draw::Format::pdf;
    EXPECT_EQ(draw::contact_sheet({of_light(5, 4, 90)}, params).bytes.substr(0, 5), "%PDF-");
}

} // namespace contact_sheet_test
