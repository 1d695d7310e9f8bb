// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/geomorphons.hpp>

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <thalweg/io/raster/raster_files.hpp>

namespace grass_forms_test {

using namespace thalweg;

namespace {

/// tests/data/grass_forms_NAME.txt: what GRASS 8.2.1 writes for samples/FILE (r.geomorphon search=15 skip=0 flat=1) in
/// 120 rows of 120 columns from a corner on: one character a cell, ':' for 10.
std::int64_t cells_that_differ(std::string const& name, std::string const& file, Cell corner) {
    std::string const sources = THALWEG_SOURCE_DIR;
    measure::Geomorphons const found = measure::geomorphons(io::read_dem(sources + "/samples/" + file));
    std::ifstream in(sources + "/tests/data/grass_forms_" + name + ".txt");
    std::int64_t differing = 0;
    std::int64_t compared = 0;
    std::string line;
    for (std::int64_t row = corner.row; std::getline(in, line); ++row) {
        for (std::size_t c = 0; c < line.size(); ++c) {
            ++compared;
            std::int64_t const col = corner.col + static_cast<std::int64_t>(c);
            differing += found.form[Cell{col, row}] != line[c] - '0' ? 1 : 0;
        }
    }
    EXPECT_EQ(compared, 120 * 120) << name;
    return differing;
}

} // namespace

// Cell by cell, ties among whole metres too.
TEST(GrassForms, CellByCell) {
    EXPECT_EQ(cells_that_differ("bigtujunga", "bigtujunga_srtm1_utm11.tif", {500, 250}), 0);
    EXPECT_EQ(cells_that_differ("jacksboro", "jacksboro_utm16.tif", {110, 120}), 0);
}

} // namespace grass_forms_test
