// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <pipeline/awkward.hpp>

namespace embed_test {

TEST(Embed, AnyByteSurvives) {
    std::string_view const bytes = thalweg::pipeline::awkward_bytes();
    std::ifstream file(THALWEG_SOURCE_DIR "/tests/data/awkward.bin", std::ios::binary);
    EXPECT_TRUE(bytes == std::string(std::istreambuf_iterator<char>(file), {}));
    ASSERT_GT(bytes.size(), 256U);
    for (int i = 0; i < 256; ++i) {
        EXPECT_EQ(bytes[static_cast<std::size_t>(i)], static_cast<char>(i));
    }
    EXPECT_NE(bytes.find("@@DATA@@)\"R\"(;[=[${x}@y@\\\\;]]"), std::string_view::npos);
}

} // namespace embed_test
