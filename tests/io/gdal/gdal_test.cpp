// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/packed.hpp>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/gdal/access.hpp>

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
