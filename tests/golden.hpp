// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

/// Compares text with tests/data/NAME; with THALWEG_RENEW=1 in the environment, writes the file again instead.
inline void expect_golden(std::string const& name, std::string const& text) {
    std::filesystem::path const path = std::filesystem::path(THALWEG_SOURCE_DIR) / "tests/data" / name;
    char const* const renew = std::getenv("THALWEG_RENEW");
    if (renew != nullptr && std::string_view(renew) == "1") {
        std::filesystem::create_directories(path.parent_path());
        std::ofstream file(path, std::ios::binary);
        file << text;
        ASSERT_TRUE(file.flush()) << "cannot write " << path;
        return;
    }
    std::ifstream file(path, std::ios::binary);
    ASSERT_TRUE(file) << "cannot read " << path << "; THALWEG_RENEW=1 writes it";
    std::string const golden{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(golden, text) << "differs from " << path << "; THALWEG_RENEW=1 writes it again";
}
