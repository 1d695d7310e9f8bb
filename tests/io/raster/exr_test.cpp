// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <string>
#include <vector>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/heightmap.hpp>

namespace exr_test {

using namespace thalweg;

namespace {

Raster<float> waves(std::int64_t width, std::int64_t height) {
    return test::raster_of(test::frame(width, height, 10.0), [](Cell c) {
        return -12.5F + 0.37F * static_cast<float>(c.col * c.col % 101) + 1e-3F * static_cast<float>(7 * c.row);
    });
}

} // namespace

TEST(Exr, OneChannelHasTheHeights) {
    ScratchFolder const folder;
    for (auto const& [width, height] : {std::pair{1, 1}, {5, 3}, {2, 65}, {131, 200}}) {
        Raster<float> const heights = waves(width, height);
        std::string const path = folder / (std::to_string(width) + ".exr");
        io::HeightmapScale const scale = io::write_heightmap(heights, path, io::HeightmapFormat::exr);
        EXPECT_EQ(scale.step_m, 0.0);
        EXPECT_EQ(scale.min_m, -12.5);
        Imf::InputFile file(path.c_str(), 0);
        EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
        EXPECT_EQ(file.header().dataWindow().max.x, width - 1);
        EXPECT_EQ(file.header().dataWindow().max.y, height - 1);
        std::vector<std::string> names;
        for (auto i = file.header().channels().begin(); i != file.header().channels().end(); ++i) {
            names.emplace_back(i.name());
            EXPECT_EQ(i.channel().type, Imf::FLOAT);
        }
        EXPECT_EQ(names, std::vector<std::string>{"Y"});
        std::vector<float> read(heights.values().size());
        Imf::FrameBuffer samples;
        samples.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(read.data()), sizeof(float),
                                       sizeof(float) * static_cast<std::size_t>(width)));
        file.setFrameBuffer(samples);
        file.readPixels(0, height - 1);
        EXPECT_TRUE(std::ranges::equal(read, heights.values()));
    }
}

TEST(Exr, HasTheSameBytesOnAnyNumberOfThreads) {
    ScratchFolder const folder;
    Raster<float> const heights = waves(300, 200);
    thalweg::Run run;
    for (int const threads : {1, 3}) {
        run.threads = threads;
        io::write_heightmap(heights, folder / (std::to_string(threads) + ".exr"), io::HeightmapFormat::exr, run);
    }
    EXPECT_EQ(test::bytes_of(folder / "1.exr"), test::bytes_of(folder / "3.exr"));
}

TEST(Exr, HolesAndFilesThatExistAreRefused) {
    ScratchFolder const folder;
    Raster<float> heights = waves(5, 3);
    auto const write = [&](char const* name) { io::write_heightmap(heights, folder / name, io::HeightmapFormat::exr); };
    write("a.exr");
    EXPECT_NE(test::message_of<IoError>([&] { write("a.exr"); }), "");
    heights[Cell{2, 1}] = std::nanf("");
    EXPECT_TRUE(test::has(test::message_of<BadInput>([&] { write("b.exr"); }), "column 2, row 1"));
    EXPECT_EQ(folder.entries(), 1);
}

} // namespace exr_test
