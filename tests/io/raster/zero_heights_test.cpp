// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Voids that are stored as 0, or as the largest number of a type, and the sea, which is no void.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/raster_files.hpp>

#include "scratch_folder.hpp"
#include "tiff.hpp"

namespace zero_heights_test {

using namespace thalweg;
using test::error_of;
using test::has;

namespace {

double hills(int col, int row) {
    return 640.0 + 200.0 * std::sin(0.3 * col) + 150.0 * std::cos(0.2 * row);
}

/// The amount of the doubt about a DEM's zeros; nothing: none.
std::optional<double> doubt(ScratchFolder const& folder, std::function<double(int, int)> const& value,
                            Tiff const& wanted = {}) {
    io::DemFile const file = io::read_dem_file(written(folder / "dem.tif", wanted, value));
    auto const at = std::ranges::find(file.findings, FindingKind("zero_heights"), &Finding::kind);
    return at == file.findings.end() ? std::nullopt : std::optional(at->amount);
}

} // namespace

TEST(ZeroHeights, VoidsAmidHeightsAreSaid) {
    ScratchFolder const folder;
    auto const scattered = [](int c, int r) { return c % 9 == 4 && r % 7 == 3 ? 0.0 : hills(c, r); };
    EXPECT_EQ(doubt(folder, hills), std::nullopt);
    EXPECT_EQ(doubt(folder, scattered), 16.0);
    // Beside another value that the file declares, singly and in a patch.
    auto const with_edge = [](int c, double z) { return c < 3 ? -9999.0 : z; };
    EXPECT_EQ(doubt(folder, [&](int c, int r) { return with_edge(c, scattered(c, r)); }, {.nodata = -9999.0}), 16.0);
    auto const patch = [&](int c, int r) {
        return with_edge(c, c > 20 && c < 26 && r > 9 && r < 14 ? 0.0 : hills(c, r));
    };
    EXPECT_EQ(doubt(folder, patch, {.nodata = -9999.0}), 20.0);
    // Single ones in the mountains of a DEM that reaches to the sea.
    auto const coast = [](int c, int r) { return c < 5 ? 0.0 : c == 30 && r == 12 ? 0.0 : 20.0 * (c - 4) + r; };
    EXPECT_EQ(doubt(folder, coast), 1.0);
    auto const corner = [](int c, int r) { return c == 39 && r == 29 ? 0.0 : hills(c, r); };
    EXPECT_EQ(doubt(folder, corner), 1.0);
}

TEST(ZeroHeights, TheSeaIsNone) {
    ScratchFolder const folder;
    auto const beach = [](int c, int r) { return std::max(0.0, 4.0 * c - 60.0 + r); };
    auto const islands = [](int c, int r) { return std::max(0.0, 300.0 * std::sin(0.4 * c) * std::sin(0.5 * r)); };
    auto const cliffs = [](int c, int r) { return c < 15 ? 0.0 : 45.0 + 8.0 * (c - 15) + r; };
    auto const polder = [](int c, int r) { return c % 9 == 4 && r % 7 == 3 ? 0.0 : -3.0 + 0.1 * c; };
    for (auto const& land : {std::function<double(int, int)>(beach), std::function<double(int, int)>(islands),
                             std::function<double(int, int)>(cliffs), std::function<double(int, int)>(polder)}) {
        EXPECT_EQ(doubt(folder, land), std::nullopt);
        EXPECT_EQ(doubt(folder, land, {.nodata = -9999.0}), std::nullopt);
    }
}

TEST(ZeroHeights, TheLargestNumberOfATypeIsNoHeight) {
    ScratchFolder const folder;
    for (double const largest : {65535.0, 32767.0}) {
        auto const single = [&](int c, int r) { return c == 11 && r == 8 ? largest : hills(c, r); };
        EXPECT_TRUE(has(error_of([&] { io::read_dem(written(folder / "dem.tif", {}, single)); }),
                        "BadInput io.read_dem", "no terrain has this height", "column 11, row 8", "-a_nodata"));
        // In decimetres it could be one: a doubt.
        EXPECT_EQ(doubt(folder, single, {.scale = 0.1}), 1.0);
    }
}

TEST(ZeroHeights, AMaskHasCodesAsTheyAreStored) {
    ScratchFolder const folder;
    Grid const grid{40, 30, 30.0, 500000.0, 5000000.0, "EPSG:32632"};
    auto const inside = [](int c, int) { return c < 10 ? 1.0 : 0.0; };
    Mask const mask = io::read_mask(written(folder / "dem.tif", {.scale = 0.5, .offset = 7.0}, inside), grid);
    EXPECT_EQ(std::ranges::count(mask.values(), 1), 300);
    auto const with_hole = [&](int c, int r) { return r < 2 ? -9999.0 : inside(c, r); };
    std::string const words = error_of([&] { io::read_mask(written(folder / "dem.tif", {}, with_hole), grid); });
    EXPECT_TRUE(has(words, "BadInput", "80 cells", "stands for no-data", "-a_nodata")) << words;
    EXPECT_EQ(words.find("height"), std::string::npos) << words;
    Mask const declared = io::read_mask(written(folder / "dem.tif", {.nodata = -9999.0}, with_hole), grid);
    EXPECT_EQ(std::ranges::count(declared.values(), 1), 280);
}

} // namespace zero_heights_test
