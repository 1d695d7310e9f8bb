// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/unused_keys.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace thalweg::pipeline {

namespace {

/// Values that recipe.toml files of earlier versions hold for keys that their recipe did not use: defaults of then, and
/// what those that were left out came to.
std::multimap<std::string, Value> const earlier_defaults = {
    {"network.concavity", 0.45},
    {"surface.roughness", 0.4},
    {"surface.mean_slope", 25.0},
};

bool is_default(Key const& key, Value const& value, bool set_by_someone) {
    static Recipe const standard = with_all_sections();
    static Recipe const built_in = default_recipe();
    auto const [first, last] = earlier_defaults.equal_range(key.help.path);
    return key.take(standard) == value ||
           std::any_of(first, last, [&](auto const& row) { return row.second == value; }) ||
           (!set_by_someone && key.take(built_in) == value);
}

std::string words_of(std::string const& path, Value const& value, std::string const& place, std::string const& lacks) {
    return fmt::format("{} = {}{} has no effect in this recipe: it needs {}. Remove it, or change that.", path,
                       toml_text(value), place.empty() ? "" : " (" + place + ")", lacks);
}

/// of: holds the key's value; recipe: decides.
void collect(Key const& key, Recipe const& of, Recipe const& recipe, std::string const& path,
             std::vector<UnusedKey>& found) {
    auto const value = key.take(of);
    auto const place = recipe.set_at.find(path);
    bool const is_set = place != recipe.set_at.end();
    if (value && !key.use.holds(recipe) && !is_default(key, *value, is_set)) {
        found.push_back({path, words_of(path, *value, is_set ? place->second : "", key.use.lacks(recipe))});
    }
}

} // namespace

std::vector<UnusedKey> unused_keys(Recipe const& recipe) {
    std::vector<UnusedKey> found;
    for (Key const& key : all_keys()) {
        if (key.section() != "patch") {
            collect(key, recipe, recipe, key.help.path, found);
            continue;
        }
        for (std::size_t i = 0; i < recipe.patches.size(); ++i) {
            Recipe one;
            one.patches.push_back(recipe.patches[i]);
            collect(key, one, recipe, fmt::format("patch.{}.{}", i + 1, key.name()), found);
        }
    }
    return found;
}

void refuse_unused_keys(Recipe const& resolved) {
    std::vector<std::string> faults;
    for (UnusedKey const& key : unused_keys(resolved)) {
        if (resolved.set_at.count(key.path) > 0) {
            faults.push_back(key.words);
        }
    }
    if (!faults.empty()) {
        throw BadParameter(fmt::format("recipe: {}", fmt::join(faults, "\nrecipe: ")));
    }
}

} // namespace thalweg::pipeline
