// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Servers that the command line names, accept a connection and never say a word.
#include <chrono>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"
#include "listening.hpp"
#include "spawned.hpp"

TEST(Unanswered, ServersAreGivenUpAfterTenSeconds) {
    Listening const server; // nobody reads what is sent to it
    Workplace const place;
    std::string const base = "PG:host=127.0.0.1 port=" + server.port() + " dbname=x";
    std::string const address = "/vsicurl/http://127.0.0.1:" + server.port() + "/a.geojson";
    for (std::vector<std::string> const& words :
         {std::vector<std::string>{"make", base, "-o", "out"}, {"make", address, "-o", "out"}, {"check", base}}) {
        auto const begin = std::chrono::steady_clock::now();
        Ended const ended = Spawned(words, place.path(), [] {}).wait(60.0);
        double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        EXPECT_FALSE(ended.hung) << words[1];
        EXPECT_EQ(ended.code, 2) << words[1] << ended.err;
        EXPECT_TRUE(test::has(ended.err, "error: "));
        EXPECT_GE(seconds, 9.0) << words[1] << ended.err;
        EXPECT_LE(seconds, 25.0) << words[1] << ", at most asked twice";
        EXPECT_TRUE(names_in(place.path()).empty());
    }
}
