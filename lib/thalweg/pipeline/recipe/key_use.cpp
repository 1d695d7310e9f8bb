// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/key_use.hpp>

#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace thalweg::pipeline {

namespace {

std::optional<Value> value_in(Recipe const& recipe, std::string const& path) {
    Key const* const key = find_key(path);
    return key == nullptr ? std::nullopt : key->take(recipe);
}

/// A value without the quotes of TOML.
std::string bare_text(Value const& value) {
    auto const* const word = std::get_if<std::string>(&value);
    return word != nullptr ? *word : toml_text(value);
}

std::string in_quotes(std::string const& word) {
    return word == "true" || word == "false" ? word : '"' + word + '"';
}

bool has_section(Recipe const& recipe, std::string const& name) {
    Section const* const section = find_section(name);
    return section != nullptr && section->count(recipe) > 0;
}

bool is_given(Recipe const& recipe, std::string const& path) {
    auto const value = value_in(recipe, path);
    return value && !bare_text(*value).empty();
}

/// A simple condition: what holds, and what the recipe has where it does not.
Use simple(std::string text, std::function<bool(Recipe const&)> holds,
           std::function<std::string(Recipe const&)> const& here) {
    Use use;
    use.lacks = [text, holds, here](Recipe const& recipe) {
        return holds(recipe) ? std::string() : text + here(recipe);
    };
    use.text = std::move(text);
    use.holds = std::move(holds);
    return use;
}

std::string nothing(Recipe const&) {
    return "";
}

std::string bracketed(Use const& use, Use::Kind kind) {
    return use.kind == kind ? "(" + use.text + ")" : use.text;
}

} // namespace

Use always() {
    return simple(
        "", [](Recipe const&) { return true; }, nothing);
}

Use with(std::string const& section) {
    return simple(
        fmt::format("[{}]", section), [section](Recipe const& r) { return has_section(r, section); }, nothing);
}

Use without(std::string const& section) {
    return simple(
        fmt::format("no [{}]", section), [section](Recipe const& r) { return !has_section(r, section); }, nothing);
}

Use is(std::string const& path, std::vector<std::string> const& words) {
    std::vector<std::string> listed;
    std::transform(words.begin(), words.end(), std::back_inserter(listed), in_quotes);
    return simple(
        fmt::format("{} = {}", path, fmt::join(listed, " or ")),
        [path, words](Recipe const& r) {
            auto const value = value_in(r, path);
            return value && std::find(words.begin(), words.end(), bare_text(*value)) != words.end();
        },
        [path](Recipe const& r) {
            auto const value = value_in(r, path);
            return value ? fmt::format(" (here it is {})", in_quotes(bare_text(*value))) : std::string();
        });
}

Use above(std::string const& path, double limit) {
    return simple(
        fmt::format("{} > {}", path, limit),
        [path, limit](Recipe const& r) {
            auto const value = value_in(r, path);
            if (auto const* const n = value ? std::get_if<std::int64_t>(&*value) : nullptr) {
                return static_cast<double>(*n) > limit;
            }
            auto const* const x = value ? std::get_if<double>(&*value) : nullptr;
            return x != nullptr && *x > limit;
        },
        nothing);
}

Use given(std::string const& path) {
    return simple(
        path, [path](Recipe const& r) { return is_given(r, path); }, nothing);
}

Use not_given(std::string const& path) {
    return simple(
        "no " + path, [path](Recipe const& r) { return !is_given(r, path); }, nothing);
}

Use when(std::string text, std::function<bool(Recipe const&)> holds) {
    return simple(std::move(text), std::move(holds), nothing);
}

Use operator&&(Use const& a, Use const& b) {
    if (a.text.empty() || b.text.empty()) {
        return a.text.empty() ? b : a;
    }
    Use use;
    use.kind = Use::Kind::both;
    use.text = bracketed(a, Use::Kind::either) + " and " + bracketed(b, Use::Kind::either);
    use.holds = [a, b](Recipe const& r) { return a.holds(r) && b.holds(r); };
    use.lacks = [a, b](Recipe const& r) {
        std::string const first = a.lacks(r);
        std::string const second = b.lacks(r);
        return first + (first.empty() || second.empty() ? "" : " and ") + second;
    };
    return use;
}

Use operator||(Use const& a, Use const& b) {
    Use use;
    use.kind = Use::Kind::either;
    use.text = bracketed(a, Use::Kind::both) + " or " + bracketed(b, Use::Kind::both);
    use.holds = [a, b](Recipe const& r) { return a.holds(r) || b.holds(r); };
    use.lacks = [a, b](Recipe const& r) {
        return a.holds(r) || b.holds(r) ? std::string() : a.lacks(r) + ", or " + b.lacks(r);
    };
    return use;
}

} // namespace thalweg::pipeline
