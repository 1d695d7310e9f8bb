// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string>

/// Exit 2, the words in the message, nothing written.
inline void expect_refused(Workplace const& place, std::string const& arguments, std::string const& words) {
    auto const before = std::distance(std::filesystem::directory_iterator(place.path()), {});
    Outcome const o = thalweg_run(arguments, place.path());
    EXPECT_EQ(o.code, 2) << arguments << "\n" << o.err;
    EXPECT_NE(o.err.find(words), std::string::npos) << arguments << "\n" << o.err;
    EXPECT_NE(("\n" + o.err).find("\nerror: "), std::string::npos) << o.err;
    EXPECT_EQ(o.out, "") << arguments;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(place.path()), {}), before) << arguments;
}
