// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/recipe.hpp>

#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

#include <fmt/format.h>

namespace thalweg::pipeline {

namespace {

/// A section, or one item of an array: its keys that have an effect.
std::string toml_of(Section const& section, std::size_t item, Recipe const& recipe) {
    std::string out;
    std::string brackets;
    for (Key const& key : all_keys()) {
        auto const value =
            key.part == &section && key.use.holds(recipe) ? key.take(recipe, item) : std::optional<Value>();
        if (!value) {
            continue;
        }
        if (key.section() != brackets) {
            brackets = key.section();
            out += section.is_array ? fmt::format("\n[[{}]]\n", brackets) : fmt::format("\n[{}]\n", brackets);
        }
        out += fmt::format("{} = {}\n", key.name(), toml_text(*value));
    }
    return out;
}

} // namespace

std::string write_recipe(Recipe const& recipe) {
    std::string out;
    for (Section const& section : all_sections()) {
        std::size_t const count = section.count(recipe);
        for (std::size_t item = 0; item < count; ++item) {
            out += toml_of(section, item, recipe);
        }
    }
    return out;
}

} // namespace thalweg::pipeline
