// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/recipe.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>
#include <thalweg/pipeline/recipe/internal/toml_entries.hpp>

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

namespace thalweg::pipeline {

namespace {

/// What an assignment names: "patch.2.rotate" is patch.rotate of item 1.
struct Target {
    std::string path;
    std::optional<std::size_t> item;
};

Target target_of(std::string const& path) {
    constexpr std::size_t most_digits = 3;
    std::size_t const begin = path.find('.') + 1;
    std::size_t const dot = path.find('.', begin);
    Section const* const section = begin == 0 ? nullptr : find_section(path.substr(0, begin - 1));
    if (section == nullptr || !section->is_array || dot == std::string::npos || dot - begin > most_digits) {
        return {path, std::nullopt};
    }
    std::size_t number = 0;
    auto const [end, error] = std::from_chars(path.data() + begin, path.data() + dot, number);
    bool const is_number = error == std::errc() && end == path.data() + dot && number > 0;
    return is_number ? Target{path.substr(0, begin) + path.substr(dot + 1), number - 1} : Target{path, std::nullopt};
}

/// A file's name as seen from the working folder, for a recipe that may lie elsewhere.
std::string from_here(Recipe const& recipe, std::string const& name) {
    bool const stays = recipe.folder.empty() || name.empty() || is_address(name);
    return stays ? name : std::filesystem::absolute(name).lexically_normal().string();
}

/// What a text without quotes means to a key.
Value value_for(Key const& key, Recipe const& recipe, std::string const& text) {
    constexpr std::size_t longest = 200;
    if (!is_utf8(text)) {
        throw BadParameter("the value is not UTF-8");
    }
    if (key.help.type == "text") {
        return key.help.is_file ? from_here(recipe, text) : text;
    }
    if (text.size() > longest) {
        throw BadParameter("the value is too long");
    }
    return value_in_toml(text);
}

void assign(Recipe& recipe, Key const& key, std::optional<std::size_t> item, std::string const& text) {
    Value const value = value_for(key, recipe, text);
    std::size_t const count = key.part->count(recipe);
    if (item && *item > count) {
        throw BadParameter(fmt::format("the recipe has {} patches", count));
    }
    key.put(recipe, value, item);
    recipe.set_at[key.place(item.value_or(key.part->count(recipe) - 1))] = "--set";
}

} // namespace

void set_key(Recipe& recipe, std::string const& assignment) {
    auto const equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
        throw BadParameter(fmt::format("--set {}: write section.key=value", cut(assignment)));
    }
    Target const target = target_of(assignment.substr(0, equals));
    Key const* const key = find_key(target.path);
    if (key == nullptr) {
        throw BadParameter(fmt::format("--set {}: {}", cut(assignment), unknown_key(cut(target.path))));
    }
    try {
        assign(recipe, *key, target.item, assignment.substr(equals + 1));
    } catch (BadParameter const& fault) {
        throw BadParameter(fmt::format("--set {}: {}", cut(assignment), fault.what()));
    }
}

} // namespace thalweg::pipeline
