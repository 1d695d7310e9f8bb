// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

namespace thalweg::pipeline {
namespace {

/// A value without the quotes of TOML, a whole number without ".0".
std::string bare_text(Value const& value) {
    if (auto const* const word = std::get_if<std::string>(&value)) {
        return *word;
    }
    auto const* const number = std::get_if<double>(&value);
    return number != nullptr ? fmt::format("{}", *number) : toml_text(value);
}

std::string in_quotes(std::string const& word) {
    return word == "true" || word == "false" ? word : '"' + word + '"';
}

/// Splits a text where " and " or " or " stands, outside brackets. The "or" between words that a key may be is part of
/// a condition: a quote or digit follows.
std::vector<std::string_view> split(std::string_view text, std::string_view at) {
    std::vector<std::string_view> parts;
    int depth = 0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
        std::string_view const rest = text.substr(i);
        if (depth == 0 && rest.starts_with(at) && rest[at.size()] != '"' &&
            std::isdigit(static_cast<unsigned char>(rest[at.size()])) == 0) {
            parts.push_back(text.substr(begin, i - begin));
            begin = i + at.size();
        }
    }
    parts.push_back(text.substr(begin));
    return parts;
}

/// `network.source = "dla" or "lines"`: a key, an operator and what stands behind it; a key alone.
struct Simple {
    std::string_view path;
    char compares = ' '; ///< =, > or <
    std::string_view with = {};
};

Simple simple_of(std::string_view text) {
    std::size_t const end = text.find(' ');
    return end == std::string_view::npos ? Simple{text}
                                         : Simple{text.substr(0, end), text[end + 1], text.substr(end + 3)};
}

std::optional<Value> value_in(Recipe const& recipe, std::string_view path) {
    Key const* const key = find_key(path);
    refuse_if<std::logic_error>(key == nullptr, "recipe: a condition of the table names {}, which is no key", path);
    return key->take(recipe);
}

/// NaN where it is left out.
double number_in(Recipe const& recipe, std::string_view path) {
    auto const value = value_in(recipe, path);
    auto const* const whole = value ? std::get_if<std::int64_t>(&*value) : nullptr;
    auto const* const real = value ? std::get_if<double>(&*value) : nullptr;
    return whole != nullptr ? static_cast<double>(*whole) : real != nullptr ? *real : std::nan("");
}

/// Whether a word is one of `"dla" or "lines"`, of `4, 12 or 16`, or is `true`.
bool is_one_of(std::string_view words, std::string const& word) {
    constexpr char const* around = "\", ";
    for (std::size_t begin = 0; (begin = words.find_first_not_of(around, begin)) != std::string_view::npos;) {
        std::size_t const end = std::min(words.find_first_of(around, begin), words.size());
        if (words.substr(begin, end - begin) == word) {
            return true;
        }
        begin = end;
    }
    return false;
}

bool is_there(Recipe const& recipe, std::string_view what) {
    if (what.front() == '[') {
        Section const* const section = find_section(what.substr(1, what.size() - 2));
        return section != nullptr && section->count(recipe) > 0;
    }
    auto const value = value_in(recipe, what);
    return value && !bare_text(*value).empty();
}

bool simple_holds(Recipe const& recipe, std::string_view text) {
    constexpr std::string_view no = "no ";
    if (text.empty() || text.starts_with(no)) {
        return text.empty() || !is_there(recipe, text.substr(no.size()));
    }
    Simple const simple = simple_of(text);
    if (simple.compares == '=') {
        auto const value = value_in(recipe, simple.path);
        return value && is_one_of(simple.with, bare_text(*value));
    }
    if (simple.compares == ' ') {
        return is_there(recipe, text);
    }
    int limit = 0;
    std::from_chars(simple.with.data(), simple.with.data() + simple.with.size(), limit);
    double const number = number_in(recipe, simple.path);
    return simple.compares == '>' ? number > limit : number < limit;
}

/// What a recipe has instead of a word.
std::string here(Recipe const& recipe, std::string_view text) {
    Simple const simple = simple_of(text);
    bool const wants_word =
        simple.compares == '=' && std::isdigit(static_cast<unsigned char>(simple.with.front())) == 0;
    auto const value = wants_word ? value_in(recipe, simple.path) : std::nullopt;
    return value ? fmt::format(" (here it is {})", in_quotes(bare_text(*value))) : "";
}

constexpr std::string_view joint_of(Use::Joins joins) {
    return joins == Use::Joins::any ? " or " : " and ";
}

} // namespace

Use read_use(std::string_view text) {
    for (Use::Joins const joins : {Use::Joins::any, Use::Joins::all}) {
        std::vector<std::string_view> const parts = split(text, joint_of(joins));
        if (parts.size() == 1) {
            continue;
        }
        Use use{"", joins};
        for (std::string_view const part : parts) {
            Use const read = read_use(part);
            bool const is_bracketed = read.joins != Use::Joins::nothing && read.joins != joins;
            use.text += fmt::format(fmt::runtime(is_bracketed ? "{}({})" : "{}{}"),
                                    use.parts.empty() ? "" : joint_of(joins), read.text);
            use.parts.push_back(read);
        }
        return use;
    }
    if (text.starts_with('(')) {
        return read_use(text.substr(1, text.size() - 2));
    }
    for (NamedCondition const& named : named_conditions()) {
        if (text == named.name) {
            return read_use(named.text);
        }
    }
    return {std::string(text)};
}

bool Use::holds(Recipe const& recipe) const {
    auto const part_holds = [&](Use const& part) { return part.holds(recipe); };
    if (test != nullptr || joins == Joins::nothing) {
        return test != nullptr ? test(recipe) : simple_holds(recipe, text);
    }
    return joins == Joins::all ? std::ranges::all_of(parts, part_holds) : std::ranges::any_of(parts, part_holds);
}

std::string Use::lacks(Recipe const& recipe) const {
    if (holds(recipe)) {
        return "";
    }
    if (test != nullptr || joins == Joins::nothing) {
        return text + (test != nullptr ? "" : here(recipe, text));
    }
    std::string lacking;
    for (Use const& part : parts) {
        std::string const lacks = part.lacks(recipe);
        bool const is_first = lacking.empty() || lacks.empty();
        lacking += (is_first ? "" : joins == Joins::any ? ", or " : " and ") + lacks;
    }
    return lacking;
}

} // namespace thalweg::pipeline
