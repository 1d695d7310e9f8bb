// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/peak_memory.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/run.hpp>

namespace peak_memory_test {

using thalweg::PeakMemory;

constexpr std::size_t block = std::size_t{96} << 20;
constexpr auto most_of_it = static_cast<std::int64_t>(block * 9 / 10);

TEST(PeakMemory, SeesABlockThatIsReleasedBeforeItIsAsked) {
    PeakMemory const empty;
    std::int64_t const before = empty.bytes();
    PeakMemory const peak;
    {
        std::vector<char, thalweg::LargePages<char>> const large(block, 'x');
        EXPECT_EQ(large[block / 2], 'x');
    }
    EXPECT_GE(peak.bytes(), before + most_of_it);
    EXPECT_GE(empty.bytes(), before + most_of_it) << "all see it that are there";
    PeakMemory const after;
    EXPECT_LT(after.bytes(), before + most_of_it) << "one that comes later does not";
}

TEST(PeakMemory, LooksWhereARunIsChecked) {
    PeakMemory const peak;
    std::int64_t const before = peak.bytes();
    {
        std::vector<char> const large(block, 'x'); // its release says nothing
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        thalweg::Run().check();
        EXPECT_EQ(large[block / 2], 'x');
    }
    EXPECT_GE(peak.bytes(), before + most_of_it);
}

} // namespace peak_memory_test
