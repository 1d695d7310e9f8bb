// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "command.hpp"
#include "spawned.hpp"

namespace durable_test {

namespace fs = std::filesystem;

TEST(Durable, FilesAreOnTheDiskBeforeTheyGetTheirName) {
    Workplace const place;
    Workplace const aside;
    auto const spied = [&] {
        setenv("SPY_LOG", (aside / "log").c_str(), 1);
        setenv("LD_PRELOAD", SPY, 1);
    };
    fs::path const folder = fs::canonical(place.path());
    auto const lines = [&] {
        std::istringstream text(file_bytes(aside / "log"));
        std::vector<std::string> all;
        for (std::string line; std::getline(text, line);) {
            all.push_back(line);
        }
        fs::remove(aside / "log");
        return all;
    };
    auto const find = [](std::vector<std::string> const& all, std::string const& begin, std::string const& end) {
        return std::find_if(all.begin(), all.end(),
                            [&](std::string const& l) { return l.starts_with(begin) && l.ends_with(end); });
    };
    ASSERT_EQ(spawn(small_make(), place.path(), spied).code, 0);
    std::vector<std::string> const made = lines();
    auto const named = find(made, "rename out.thalweg-tmp-", " out");
    ASSERT_NE(named, made.end());
    for (std::string const& name : names_in(place / "out")) {
        EXPECT_LT(find(made, "fsync " + (folder / "out.thalweg-tmp-").string(), "/" + name), named) << name;
    }
    EXPECT_NE(std::find(named, made.end(), "fsync " + folder.string()), made.end()) << "the folder's list of names";

    ASSERT_EQ(spawn({"points", "out/dem.tif", "-o", "p.las"}, place.path(), spied).code, 0);
    std::vector<std::string> const one = lines();
    auto const placed = find(one, "rename ", " p.las");
    ASSERT_NE(placed, one.end());
    EXPECT_LT(find(one, "fsync ", "-p.las"), placed);
    EXPECT_NE(std::find(placed, one.end(), "fsync " + folder.string()), one.end());
}

} // namespace durable_test
