// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Of builds without OpenEXR.
#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/heightmap.hpp>

namespace exr_absent_test {

using namespace thalweg;

TEST(Exr, IsRefusedInWords) {
    ScratchFolder const folder;
    Raster<float> const heights(test::frame(3, 2), 80.0F);
    EXPECT_TRUE(test::has(test::message_of<BadParameter>(
                              [&] { io::write_heightmap(heights, folder / "a.exr", io::HeightmapFormat::exr); }),
                          "built without it", "libopenexr-dev", "r32"));
    EXPECT_EQ(folder.entries(), 0);
}

} // namespace exr_absent_test
