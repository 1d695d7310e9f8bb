// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <thalweg/pipeline/recipe/recipe.hpp>

/// Conditions under which a key of a recipe has an effect. Private to this module.
namespace thalweg::pipeline {

/// A condition on a recipe, for the program and in words.
struct Use {
    std::string text; ///< `surface.method = "diffuse"`; "" holds for every recipe
    std::function<bool(Recipe const&)> holds;
    /// What a recipe lacks for it to hold and what it has instead; "" where it holds.
    std::function<std::string(Recipe const&)> lacks;
    enum class Kind { simple, both, either } kind = Kind::simple;
};

Use always();
/// A section that is there: "network", "statistics"; of an array, an item of it.
Use with(std::string const& section);
Use without(std::string const& section);
/// A key, left out or not, has one of these values, as they stand in a recipe file without quotes.
Use is(std::string const& path, std::vector<std::string> const& words);
/// A number is greater than this.
Use above(std::string const& path, double limit);
/// A key is given; a text is not "".
Use given(std::string const& path);
Use not_given(std::string const& path);
/// A condition of its own, in words.
Use when(std::string text, std::function<bool(Recipe const&)> holds);

Use operator&&(Use const& a, Use const& b);
Use operator||(Use const& a, Use const& b);

} // namespace thalweg::pipeline
