// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <support.hpp>

#include <thalweg/pipeline/make/make.hpp>

namespace test {

/// What a recipe makes whose files lie in a folder.
inline thalweg::pipeline::Made made(std::string const& toml, std::string const& folder = "") {
    thalweg::pipeline::Recipe recipe = thalweg::pipeline::read_recipe(toml, "test");
    recipe.folder = folder;
    return thalweg::pipeline::make(recipe);
}

/// What such a recipe is refused for; nothing where it is made.
inline std::string fault_of(std::string const& toml, std::string const& folder = "") {
    return message_of([&] { made(toml, folder); });
}

} // namespace test
