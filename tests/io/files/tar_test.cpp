// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/tar.hpp>

#include <string>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>

namespace tar_test {

using namespace thalweg;

TEST(Tar, AnEntryIsAHeaderAndWholeBlocks) {
    std::string const entry = io::tar_entry("a/b.txt", "seven!\n");
    ASSERT_EQ(entry.size(), 1024U);
    EXPECT_EQ(entry.substr(0, 8), std::string("a/b.txt\0", 8));
    EXPECT_EQ(entry.substr(124, 11), "00000000007");
    EXPECT_EQ(entry.substr(257, 8), std::string("ustar\00000", 8));
    EXPECT_EQ(entry.substr(512, 7), "seven!\n");
    EXPECT_EQ(entry.substr(519), std::string(505, '\0'));
    // The checksum is of the header with eight spaces in its place.
    unsigned sum = 8 * ' ';
    for (std::size_t i = 0; i < 512; ++i) {
        sum += i < 148 || i >= 156 ? static_cast<unsigned char>(entry[i]) : 0;
    }
    EXPECT_EQ(std::stoul(entry.substr(148, 6), nullptr, 8), sum);
    EXPECT_EQ(io::tar_entry("x", "").size(), 512U);
    EXPECT_EQ(io::tar_entry("x", std::string(512, 'y')).size(), 1024U);
    EXPECT_EQ(io::tar_end(), std::string(1024, '\0'));
}

TEST(Tar, ANameOf100BytesFits) {
    EXPECT_NO_THROW(io::tar_entry(std::string(100, 'a'), ""));
    EXPECT_THROW(io::tar_entry(std::string(101, 'a'), ""), BadParameter);
    EXPECT_THROW(io::tar_entry("", ""), BadParameter);
}

} // namespace tar_test
