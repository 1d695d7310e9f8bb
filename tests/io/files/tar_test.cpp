// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/tar.hpp>

#include <string>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>

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

TEST(Tar, EntriesAreListed) {
    ScratchFolder const folder;
    std::string const first = io::tar_entry("a.txt", "seven!\n");
    std::string const whole =
        first + io::tar_entry("b", "") + io::tar_entry("c", std::string(513, 'y')) + io::tar_end();
    folder.write("all.tar", whole);
    auto const entries = io::tar_entries(folder / "all.tar");
    ASSERT_EQ(entries.size(), 3U);
    EXPECT_EQ(entries[0].name + entries[1].name + entries[2].name, "a.txtbc");
    EXPECT_EQ(entries[0].begin, 0);
    EXPECT_EQ(entries[0].end, 1024);
    EXPECT_EQ(entries[1].end, 1536);
    EXPECT_EQ(entries[2].end, 1536 + 512 + 1024);
    EXPECT_EQ(whole.substr(0, 1024), first);
    for (std::size_t const cut : {std::size_t{100}, std::size_t{700}, std::size_t{1536}, whole.size() - 1024}) {
        folder.write("cut.tar", whole.substr(0, cut));
        EXPECT_THROW(io::tar_entries(folder / "cut.tar"), BadInput) << cut;
    }
    std::string damaged = whole;
    damaged[1024 + 130] = 'x';
    folder.write("damaged.tar", damaged);
    EXPECT_THROW(io::tar_entries(folder / "damaged.tar"), BadInput);
    EXPECT_THROW(io::tar_entries(folder / "none.tar"), IoError);
}

TEST(Tar, ANameOf100BytesFits) {
    EXPECT_NO_THROW(io::tar_entry(std::string(100, 'a'), ""));
    EXPECT_THROW(io::tar_entry(std::string(101, 'a'), ""), BadParameter);
    EXPECT_THROW(io::tar_entry("", ""), BadParameter);
}

} // namespace tar_test
