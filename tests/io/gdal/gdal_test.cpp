// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/packed.hpp>

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gdal.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/tables/table.hpp>

#include "unpacked.hpp"

namespace gdal_test {

using namespace thalweg;
using Bytes = std::vector<std::uint8_t>;

TEST(Packed, NothingIsAStreamOfNothing) {
    std::string const text = io::packed({});
    EXPECT_FALSE(text.empty());
    EXPECT_TRUE(unpacked(text).empty());
}

TEST(Packed, ByteByByteTheSameAgain) {
    ASSERT_TRUE(rc::check("unpacked(packed(bytes)) == bytes", [] {
        auto const bytes = *rc::gen::container<Bytes>(rc::gen::arbitrary<std::uint8_t>());
        RC_ASSERT(unpacked(io::packed(bytes)) == bytes);
    }));
}

TEST(Packed, MoreThanOnePieceOfBase64) {
    Bytes noise(10'000'001);
    for (std::size_t i = 0; i < noise.size(); ++i) {
        noise[i] = static_cast<std::uint8_t>(random_word(7, i));
    }
    std::string const text = io::packed(noise);
    EXPECT_GT(text.size(), noise.size());
    EXPECT_TRUE(unpacked(text) == noise);
    Bytes const plain(noise.size(), 3);
    EXPECT_LT(io::packed(plain).size(), noise.size() / 100);
}

TEST(Packed, BeyondTwoGibibytesIsRefused) {
    std::uint8_t const one = 0;
    std::span<std::uint8_t const> const too_many(&one, std::size_t{1} << 31U); // refused before a byte is read
    EXPECT_THROW(io::packed(too_many), BadInput);
}

// A name with an address would read the program's memory as it stands, whatever lies there.
TEST(Access, NamesThatHoldAnAddressAreNotOpened) {
    io::Driver const driver;
    std::vector<std::uint8_t> const cells(16, 7);
    std::string const name =
        fmt::format("MEM:::DATAPOINTER={},PIXELS=4,LINES=4", static_cast<void const*>(cells.data()));
    EXPECT_EQ(GDALOpenEx(name.c_str(), GDAL_OF_RASTER, nullptr, nullptr, nullptr), nullptr);
    GDALDatasetH const made = GDALCreate(GDALGetDriverByName("MEM"), "", 4, 4, 1, GDT_Byte, nullptr);
    EXPECT_NE(made, nullptr) << "it may still be made";
    GDALClose(made);
}

TEST(Threads, OneReadsAFileOfARecipeWhileAnotherWritesElsewhere) {
    io::TemporaryFolder const folder("thalweg-threads");
    auto const lines = [](std::size_t rows) {
        io::Table table;
        table.name = "rivers";
        table.shape = io::Table::Shape::plan_line;
        table.rows = rows;
        table.shape_at = [](std::size_t row) {
            auto const y = static_cast<double>(row);
            return std::vector<Vec3>{{500000.0, y, 0.0}, {500100.0, y, 0.0}};
        };
        return table;
    };
    std::string const read = (folder.path() / "read" / "rivers.gpkg").string();
    std::filesystem::create_directories(folder.path() / "read");
    std::filesystem::create_directories(folder.path() / "written");
    io::write_tables({lines(200)}, "EPSG:32631", read);
    std::atomic<bool> is_done = false;
    std::string fault;
    std::thread reader([&] {
        while (!is_done) {
            try {
                EXPECT_EQ(io::read_rivers({.path = {read, io::Access::recipe}}).lines.size(), 200U);
            } catch (std::exception const& error) {
                fault = error.what();
            }
        }
    });
    for (int i = 0; i < 20; ++i) {
        std::string const path = (folder.path() / "written" / (std::to_string(i) + ".gpkg")).string();
        EXPECT_NO_THROW(io::write_tables({lines(3)}, "EPSG:32631", path)) << i;
    }
    is_done = true;
    reader.join();
    EXPECT_EQ(fault, "");
}

TEST(NamesConnection, DatabasesAndFilesBehindAnAddress) {
    for (auto const& [name, is_one] :
         std::vector<std::pair<std::string, bool>>{{"PG:dbname=x", true},
                                                   {"postgresql://h/x", true},
                                                   {"postgres://h/x", true},
                                                   {"/vsicurl/http://h/a.tif", true},
                                                   {"/vsizip/vsicurl/http://h/a.zip", true},
                                                   {"/vsizip//vsicurl/http://h/a.zip", true},
                                                   {"/vsizip/{/vsicurl/http://h/a.zip}/a.tif", true},
                                                   {"/vsistdin/", true},
                                                   {"/vsizip/a.zip/a.gpkg", false},
                                                   {"/vsimem/a.tif", false},
                                                   {"PG.gpkg", false},
                                                   {"a.gpkg", false}}) {
        EXPECT_EQ(io::names_connection(name), is_one) << name;
    }
}

} // namespace gdal_test
