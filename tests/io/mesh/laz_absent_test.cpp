// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Of builds without LASzip.
#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/io/mesh/points.hpp>

#include "las_files.hpp"
#include "scratch_folder.hpp"

namespace laz_absent_test {

using namespace thalweg;

TEST(ReadLaz, IsRefusedInWords) {
    ScratchFolder const folder;
    las_files::File const file{.points = {{{1, 2, 3}}, {{2, 2, 3}}, {{1, 3, 3}}}};
    for (unsigned const mark : {0x80U, 0x40U}) { // of the point format, by either of which LASzip says that it is one
        folder.write("a.laz", las_files::with(las_files::bytes_of(file), 104, static_cast<char>(mark)));
        std::string const words = test::error_of([&] { io::read_points({folder / "a.laz"}); });
        EXPECT_TRUE(test::has(words, "BadInput io.read_points: a.laz is compressed", "built without LASzip",
                              "pdal translate ", "laszip -i ", "liblaszip-dev", "a.plain.las"));
    }
}

} // namespace laz_absent_test
