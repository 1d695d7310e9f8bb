// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/points.hpp>

#include <cmath>
#include <limits>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

#include "full_disk.hpp"
#include "point_files.hpp"
#include "scratch_folder.hpp"

namespace write_points_test {

using namespace thalweg;
using io::PointFormat;
using io::write_points;

namespace {

using test::frame_below;
using test::has;
using test::message_of;

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// Heights that do not end in binary, a hole in every eleventh cell.
Raster<float> land(std::int64_t width = 13, std::int64_t height = 7, double cell_m = 2.5) {
    Raster<float> z(Grid{width, height, cell_m, 300000.1, 5200000.7, "EPSG:32631"});
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        z[i] = i % 11 == 4 ? none
                           : static_cast<float>(1000.0 * unit(random_word(1, static_cast<std::uint64_t>(i)))) - 50.0F;
    }
    return z;
}

/// The cells a file of a raster shall hold, one of so many rows and columns.
std::vector<Vec3> cells_of(Raster<float> const& z, std::int64_t every = 1) {
    std::vector<Vec3> points;
    for (std::int64_t row = 0; row < z.height(); ++row) {
        for (std::int64_t col = 0; col < z.width(); ++col) {
            Cell const cell{col, row};
            if (row % every == 0 && col % every == 0 && !std::isnan(z[cell])) {
                Vec2 const at = z.grid().centre(cell);
                points.push_back({at.x, at.y, static_cast<double>(z[cell])});
            }
        }
    }
    return points;
}

void expect_near(std::vector<Vec3> const& found, std::vector<Vec3> const& wanted, double within) {
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i].x, wanted[i].x, within) << i;
        EXPECT_NEAR(found[i].y, wanted[i].y, within) << i;
        EXPECT_NEAR(found[i].z, wanted[i].z, within) << i;
    }
}

std::vector<PointFormat> formats() {
    return {PointFormat::las, PointFormat::ply, PointFormat::xyz};
}

} // namespace

TEST(WritePoints, FormatsByNameAndEnding) {
    EXPECT_EQ(io::point_format("", "a/b.las"), PointFormat::las);
    EXPECT_EQ(io::point_format("", "B.PLY"), PointFormat::ply);
    EXPECT_EQ(io::point_format("xyz", "b.las"), PointFormat::xyz);
    EXPECT_THROW(io::point_format("", "b.laz"), BadParameter);
    EXPECT_THROW(io::point_format("", "las"), BadParameter);
    EXPECT_THROW(io::point_format("laz", "b.las"), BadParameter);
}

TEST(WritePoints, NothingAndWrongNumbersAreRefused) {
    ScratchFolder const folder;
    for (PointFormat const format : formats()) {
        auto const refused = [&](auto const& what) {
            return message_of<BadInput>([&] { write_points(what, folder / "points", {.format = format}); });
        };
        EXPECT_TRUE(has(refused(FeaturePoints{}), "there is no point"));
        EXPECT_TRUE(has(refused(Raster<float>()), "there is no point"));
        EXPECT_TRUE(has(refused(Raster<float>(frame_below(2, 2), none)), "there is no point"));
        EXPECT_TRUE(has(refused(FeaturePoints{{{1, 2, 3}, {1, NAN, 3}}, ""}), "point 2 is not finite"));
        Raster<float> endless(frame_below(2, 2), 1.0F);
        endless[3] = std::numeric_limits<float>::infinity();
        EXPECT_TRUE(has(refused(endless), "the cell at (1.5, -1.5) is inf"));
        EXPECT_THROW(write_points(land(), folder / "points", {.format = format, .every = 0}), BadParameter);
        EXPECT_THROW(write_points(FeaturePoints{{{1, 2, 3}}, ""}, folder / "points", {.every = -1}), BadParameter);
        EXPECT_THROW(write_points(Skeleton{land()}, Mask(frame_below(13, 7)), folder / "points", {.format = format}),
                     BadInput);
    }
    EXPECT_EQ(folder.entries(), 0);
}

TEST(WritePoints, OnePoint) {
    ScratchFolder const folder;
    FeaturePoints const one{{{0.1, -0.25, 1e-7}}, ""};
    std::int64_t const most = std::numeric_limits<std::int64_t>::max();
    EXPECT_EQ(write_points(one, folder / "a.las", {.every = most}), 1U);
    EXPECT_EQ(write_points(one, folder / "a.ply", {.format = PointFormat::ply, .every = most}), 1U);
    EXPECT_EQ(write_points(one, folder / "a.xyz", {.format = PointFormat::xyz, .every = most}), 1U);
    expect_near(point_files::read_las(bytes_of(folder / "a.las")).points, one.points, 0.0005);
    EXPECT_EQ(point_files::read_ply_points(bytes_of(folder / "a.ply")), one.points);
    EXPECT_EQ(point_files::read_xyz(bytes_of(folder / "a.xyz")), one.points);
}

// Law: all cells with a height, row by row; bit for bit but for LAS.
TEST(WritePoints, CellsReadBack) {
    Raster<float> const z = land();
    for (std::int64_t const every : {1, 2, 3, 12, 100}) {
        ScratchFolder const folder;
        auto const wanted = cells_of(z, every);
        for (PointFormat const format : formats()) {
            std::string const name = folder / std::to_string(static_cast<int>(format));
            EXPECT_EQ(write_points(z, name, {.format = format, .every = every}), wanted.size());
            std::string const bytes = bytes_of(name);
            if (format == PointFormat::las) {
                auto const las = point_files::read_las(bytes);
                expect_near(las.points, wanted, 0.0005 + 1e-9);
                EXPECT_EQ(las.classes, std::vector<int>(wanted.size(), 2));
                EXPECT_EQ(las.epsg, 32631);
            } else if (format == PointFormat::ply) {
                EXPECT_EQ(point_files::read_ply_points(bytes), wanted);
                EXPECT_TRUE(has(bytes, "\ncomment crs EPSG:32631\n"));
            } else {
                auto found = point_files::read_xyz(bytes);
                for (Vec3& p : found) {
                    p.z = static_cast<double>(static_cast<float>(p.z));
                }
                EXPECT_EQ(found, wanted);
            }
        }
    }
}

TEST(WritePoints, TextIsShort) {
    ScratchFolder const folder;
    Raster<float> z(Grid{2, 1, 1.0, 0.0, 1.0, ""});
    z[0] = 0.1F;
    z[1] = -7.0F;
    write_points(z, folder / "a.xyz", {.format = PointFormat::xyz});
    EXPECT_EQ(bytes_of(folder / "a.xyz"), "0.5 0.5 0.1\n1.5 0.5 -7\n");
}

TEST(WritePoints, PointsOfAFileKeepTheirOrder) {
    ScratchFolder const folder;
    FeaturePoints points{{}, "EPSG:2154"};
    for (std::uint64_t i = 0; i < 10000; ++i) {
        auto const words = random_block(3, i);
        points.points.push_back({1e6 * unit(words[0]), 7e6 / 3.0 - unit(words[1]), unit(words[2])});
    }
    EXPECT_EQ(write_points(points, folder / "a.ply", {.format = PointFormat::ply}), 10000U);
    EXPECT_EQ(point_files::read_ply_points(bytes_of(folder / "a.ply")), points.points);
    EXPECT_EQ(write_points(points, folder / "a.xyz", {.format = PointFormat::xyz}), 10000U);
    EXPECT_EQ(point_files::read_xyz(bytes_of(folder / "a.xyz")), points.points);
    EXPECT_EQ(write_points(points, folder / "a.las"), 10000U);
    auto const las = point_files::read_las(bytes_of(folder / "a.las"));
    expect_near(las.points, points.points, 0.0005 + 1e-9);
    EXPECT_EQ(las.classes, std::vector<int>(10000, 8));
    EXPECT_EQ(las.epsg, 2154);
    EXPECT_EQ(write_points(points, folder / "b.ply", {.format = PointFormat::ply, .every = 3}), 3334U);
    EXPECT_EQ(point_files::read_ply_points(bytes_of(folder / "b.ply"))[3333], points.points[9999]);
}

TEST(WritePoints, SkeletonsTellRiversFromTheRest) {
    ScratchFolder const folder;
    Skeleton const skeleton{land()};
    Mask rivers(skeleton.z.grid());
    std::vector<int> wanted;
    for (std::int64_t i = 0; i < rivers.cells(); ++i) {
        rivers[i] = i % 3 == 0 ? 1 : 0;
        if (!std::isnan(skeleton.z[i])) {
            wanted.push_back(i % 3 == 0 ? 9 : 8);
        }
    }
    EXPECT_EQ(write_points(skeleton, rivers, folder / "a.las"), wanted.size());
    auto const las = point_files::read_las(bytes_of(folder / "a.las"));
    expect_near(las.points, cells_of(skeleton.z), 0.0005 + 1e-9);
    EXPECT_EQ(las.classes, wanted);
}

TEST(WritePoints, LasStepsFollowTheLand) {
    ScratchFolder const folder;
    Raster<float> const small = land(5, 5, 0.04);
    write_points(small, folder / "small.las");
    auto const fine = point_files::read_las(bytes_of(folder / "small.las"));
    EXPECT_EQ(fine.scale, (std::array<double, 3>{1e-5, 1e-5, 1e-5}));
    expect_near(fine.points, cells_of(small), 0.5e-5 + 1e-9);
    write_points(FeaturePoints{{{-9e6, 0, 0}, {9e6, 0, 2e9}}, ""}, folder / "wide.las");
    auto const wide = point_files::read_las(bytes_of(folder / "wide.las"));
    EXPECT_DOUBLE_EQ(wide.scale[0], 0.01);
    EXPECT_DOUBLE_EQ(wide.scale[1], 0.001);
    EXPECT_DOUBLE_EQ(wide.scale[2], 1.0);
    EXPECT_EQ(wide.points[1], (Vec3{9e6, 0.0, 2e9}));
}

TEST(WritePoints, NothingIsOverwrittenAndBytesAreTheSame) {
    for (PointFormat const format : formats()) {
        ScratchFolder const folder;
        write_points(land(), folder / "a", {.format = format});
        write_points(land(), folder / "b", {.format = format});
        std::string const first = bytes_of(folder / "a");
        EXPECT_EQ(first, bytes_of(folder / "b"));
        EXPECT_THROW(write_points(land(5, 5), folder / "a", {.format = format}), IoError);
        EXPECT_EQ(first, bytes_of(folder / "a"));
        EXPECT_THROW(write_points(land(), folder / "none/a", {.format = format}), IoError);
    }
}

TEST(WritePoints, FullDiskIsAnErrorAndStopsWhenAsked) {
    for (PointFormat const format : formats()) {
        ScratchFolder const folder;
        {
            FullDisk const full(512);
            EXPECT_THROW(write_points(land(), folder / "a", {.format = format}), IoError);
            EXPECT_THROW(write_points(land(400, 400), folder / "b", {.format = format}), IoError);
        }
        std::stop_source stop;
        stop.request_stop();
        thalweg::Run run;
        run.stop = stop.get_token();
        EXPECT_THROW(write_points(land(), folder / "c", {.format = format}, run), Cancelled);
    }
}

} // namespace write_points_test
