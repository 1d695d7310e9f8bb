// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <support.hpp>

#include <thalweg/make/make.hpp>

namespace test {

/// What a recipe makes whose files lie in a folder.
inline thalweg::make::MakeResult made(std::string const& toml, std::string const& folder = "",
                                      thalweg::Run const& run = {}) {
    thalweg::recipe::Recipe recipe = thalweg::recipe::read_recipe(toml, "test");
    recipe.folder = folder;
    return thalweg::make::make(recipe, run);
}

/// What is wrong with such a recipe; "" where a terrain is made.
inline std::string fault_of(std::string const& toml, std::string const& folder = "") {
    return message_of([&] { made(toml, folder); });
}

/// Recipes that are refused, each with these words.
inline void expect_faults(std::vector<std::pair<std::string, std::string>> const& cases, std::string const& folder) {
    for (auto const& [toml, words] : cases) {
        EXPECT_TRUE(has(fault_of(toml, folder), words)) << toml;
    }
}

} // namespace test
