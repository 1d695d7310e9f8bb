// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Of builds with LASzip.
#include <algorithm>

#include <gtest/gtest.h>
#include <laszip/laszip_api.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/io/mesh/points.hpp>

#include "las_files.hpp"
#include "scratch_folder.hpp"

namespace laz_test {

using namespace thalweg;

namespace {

/// Compresses a file as LASzip itself does.
void compress(std::string const& from, std::string const& to) {
    laszip_POINTER reader = nullptr;
    laszip_POINTER writer = nullptr;
    ASSERT_EQ(laszip_create(&reader), 0);
    ASSERT_EQ(laszip_create(&writer), 0);
    laszip_BOOL is_compressed = 0;
    ASSERT_EQ(laszip_open_reader(reader, from.c_str(), &is_compressed), 0);
    ASSERT_EQ(is_compressed, 0);
    laszip_header* header = nullptr;
    laszip_point* point = nullptr;
    ASSERT_EQ(laszip_get_header_pointer(reader, &header), 0);
    ASSERT_EQ(laszip_get_point_pointer(reader, &point), 0);
    auto const count = header->number_of_point_records > 0 ? header->number_of_point_records
                                                           : header->extended_number_of_point_records;
    ASSERT_EQ(laszip_set_header(writer, header), 0);
    ASSERT_EQ(laszip_open_writer(writer, to.c_str(), 1), 0);
    for (laszip_U64 i = 0; i < count; ++i) {
        ASSERT_EQ(laszip_read_point(reader), 0);
        ASSERT_EQ(laszip_set_point(writer, point), 0);
        ASSERT_EQ(laszip_write_point(writer), 0);
    }
    ASSERT_EQ(laszip_close_writer(writer), 0);
    laszip_close_reader(reader);
    laszip_destroy(writer);
    laszip_destroy(reader);
}

} // namespace

TEST(ReadLaz, ReadsWhatLasHas) {
    for (auto const& [minor, format] : {std::pair{2, 0}, std::pair{2, 1}, std::pair{2, 2}, std::pair{2, 3},
                                        std::pair{4, 6}, std::pair{4, 7}, std::pair{4, 8}}) {
        ScratchFolder const folder;
        las_files::File file{
            .minor = minor, .format = format, .records = {las_files::keys({{1024, 1}, {3072, 32631}})}};
        for (std::uint64_t i = 0; i < 70000; ++i) {
            file.points.push_back({{500000.0 + 900.0 * unit(random_word(1, i)),
                                    4000000.0 + 900.0 * unit(random_word(2, i)), 100.0 * unit(random_word(3, i))},
                                   static_cast<int>(i % 4),
                                   i % 7 == 0});
        }
        folder.write("a.las", las_files::bytes_of(file));
        compress(folder / "a.las", folder / "a.laz");
        ASSERT_LT(test::bytes_of(folder / "a.laz").size(), test::bytes_of(folder / "a.las").size());
        FeaturePoints const wanted = io::read_points({folder / "a.las"});
        FeaturePoints const found = io::read_points({folder / "a.laz"});
        EXPECT_EQ(found.points, wanted.points) << format;
        EXPECT_EQ(found.crs, "EPSG:32631");
        std::string const whole = test::bytes_of(folder / "a.laz");
        for (std::size_t const part : {3U, 2U}) {
            folder.write("b.laz", whole.substr(0, whole.size() / part));
            EXPECT_TRUE(test::has(test::error_of([&] { io::read_points({folder / "b.laz"}); }),
                                  "BadInput io.read_points", "b.laz"));
        }
    }
}

} // namespace laz_test
