// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/page.hpp>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <thalweg/pipeline/report/internal/page_template.hpp>

namespace fill_page_test {

using namespace thalweg::pipeline;

namespace {

std::string const bare = "@@TITLE@@@@DATA@@@@HEIGHTS@@@@LINES@@";

} // namespace

TEST(FillPage, EachPartWhereItsMarkerStands) {
    PageParts const parts{"t", "d", "h", "l"};
    EXPECT_EQ(fill_page(bare, parts), "tdhl");
    EXPECT_EQ(fill_page("0@@LINES@@1@@HEIGHTS@@2@@DATA@@3@@TITLE@@4", parts), "0l1h2d3t4");
    EXPECT_EQ(fill_page(bare, {}), "");
}

TEST(FillPage, WhatLooksLikeAMarkerInAPartStays) {
    EXPECT_EQ(fill_page(bare, {"@@DATA@@", "@@TITLE@@$1\\1", "@@LINES@@", "@@"}), "@@DATA@@@@TITLE@@$1\\1@@LINES@@@@");
}

TEST(FillPage, AMissingOrSecondMarkerIsAnErrorOfTheBuild) {
    for (std::string const marker : {"@@TITLE@@", "@@DATA@@", "@@HEIGHTS@@", "@@LINES@@"}) {
        std::string missing = bare;
        missing.erase(missing.find(marker), marker.size());
        EXPECT_THROW(fill_page(missing, {}), std::logic_error) << marker;
        EXPECT_THROW(fill_page(bare + marker, {}), std::logic_error) << marker;
    }
}

TEST(FillPage, TheBuiltInPageIsTheFileAndHoldsEachMarkerOnce) {
    std::ifstream file(THALWEG_SOURCE_DIR "/web/dist/report.html", std::ios::binary);
    std::string const bytes{std::istreambuf_iterator<char>(file), {}};
    EXPECT_FALSE(bytes.empty());
    EXPECT_TRUE(page_template() == bytes);
    EXPECT_NO_THROW(fill_page(page_template(), {}));
}

} // namespace fill_page_test
