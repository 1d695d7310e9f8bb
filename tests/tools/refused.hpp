// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"

/// Everything below a folder, with the bytes of the files.
inline std::map<std::string, std::string> content(std::filesystem::path const& folder) {
    std::map<std::string, std::string> all;
    for (auto const& entry : std::filesystem::recursive_directory_iterator(folder)) {
        all[entry.path().lexically_relative(folder).string()] =
            entry.is_regular_file() ? file_bytes(entry.path()) : std::string();
    }
    return all;
}

/// Exit 2, the words in the message, nothing written.
inline void expect_refused(Workplace const& place, std::string const& arguments, std::string const& words) {
    auto const before = content(place.path());
    Outcome const o = thalweg_run(arguments, place.path());
    EXPECT_EQ(o.code, 2) << arguments << "\n" << o.err;
    EXPECT_TRUE(test::has(o.err, words)) << arguments << "\n";
    EXPECT_TRUE(test::has(("\n" + o.err), "\nerror: "));
    EXPECT_EQ(o.out, "") << arguments;
    EXPECT_TRUE(content(place.path()) == before) << arguments;
}
