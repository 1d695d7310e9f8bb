// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/unused_keys.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace thalweg::pipeline {

namespace {

bool is_default(Key const& key, Value const& value, bool set_by_someone) {
    static Recipe const standard = with_all_sections();
    static std::array<Recipe, 2> const built_in = {default_recipe(), cluster_recipe()};
    return key.take(standard) == value || std::count(key.earlier.begin(), key.earlier.end(), value) > 0 ||
           (!set_by_someone && std::any_of(built_in.begin(), built_in.end(),
                                           [&](Recipe const& recipe) { return key.take(recipe) == value; }));
}

std::string words_for_unused(std::string const& path, Value const& value, std::string const& place,
                             std::string const& lacks) {
    return fmt::format("{} = {}{} has no effect in this recipe: it needs {}. Remove it, or change that.", path,
                       toml_text(value), place.empty() ? "" : " (" + place + ")", lacks);
}

} // namespace

std::vector<UnusedKey> unused_keys(Recipe const& recipe) {
    std::vector<UnusedKey> found;
    for (Key const& key : all_keys()) {
        std::size_t const count = key.use.holds(recipe) ? 0 : key.part->count(recipe);
        for (std::size_t item = 0; item < count; ++item) {
            std::string const path = key.place(item);
            auto const value = key.take(recipe, item);
            auto const place = recipe.set_at.find(path);
            bool const is_set = place != recipe.set_at.end();
            if (value && !is_default(key, *value, is_set)) {
                found.push_back(
                    {path, words_for_unused(path, *value, is_set ? place->second : "", key.use.lacks(recipe))});
            }
        }
    }
    return found;
}

void refuse_unused_keys(Recipe const& resolved) {
    std::vector<std::string> faults;
    for (UnusedKey const& key : unused_keys(resolved)) {
        if (resolved.set_at.contains(key.path)) {
            faults.push_back(key.words);
        }
    }
    if (!faults.empty()) {
        throw BadParameter(fmt::format("recipe: {}", fmt::join(faults, "\nrecipe: ")));
    }
}

} // namespace thalweg::pipeline
