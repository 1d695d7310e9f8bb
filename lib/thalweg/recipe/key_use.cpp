// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cctype>
#include <charconv>
#include <stdexcept>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::recipe {
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

bool begins_number(std::string_view text) {
    return std::isdigit(static_cast<unsigned char>(text.front())) != 0;
}

/// Splits a text where " and " or " or " stands, outside brackets. The "or" between words that a key may be is part of
/// a condition: a quote or digit follows.
std::vector<std::string_view> split_condition(std::string_view text, std::string_view at) {
    std::vector<std::string_view> parts;
    int depth = 0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
        std::string_view const rest = text.substr(std::min(i + at.size(), text.size()));
        if (depth == 0 && text.substr(i).starts_with(at) && rest.front() != '"' && !begins_number(rest)) {
            parts.push_back(text.substr(begin, i - begin));
            begin = i + at.size();
        }
    }
    parts.push_back(text.substr(begin));
    return parts;
}

/// Throws where the table itself is wrong.
template <class Found> Found const& in_table(Found const* found, std::string_view name) {
    refuse_if<std::logic_error>(found == nullptr, "recipe: a condition of the table names {}, which is unknown", name);
    return *found;
}

std::optional<Value> value_in(Recipe const& recipe, std::string_view path) {
    return in_table(find_key(path), path).take(recipe);
}

/// Whether a word is one of `"dla" or "lines"`, of `4, 12 or 16`, or is `true`.
bool is_one_of(std::string_view words, std::string_view word) {
    constexpr char const* around = "\", ";
    std::size_t end = 0;
    for (std::size_t at = words.find_first_not_of(around); at < words.size();
         at = words.find_first_not_of(around, end)) {
        end = std::min(words.find_first_of(around, at), words.size());
        if (words.substr(at, end - at) == word) {
            return true;
        }
    }
    return false;
}

double number_of(Value const& value) {
    auto const* const whole = std::get_if<std::int64_t>(&value);
    return whole != nullptr ? static_cast<double>(*whole) : std::get<double>(value);
}

bool is_there(Recipe const& recipe, std::string_view what) {
    if (what.front() == '[') {
        return in_table(find_section(what.substr(1, what.size() - 2)), what).count(recipe) > 0;
    }
    auto const value = value_in(recipe, what);
    return value && !bare_text(*value).empty();
}

/// What a recipe lacks of a condition without "and" and "or".
std::string lacking_of_simple(Recipe const& recipe, std::string_view text) {
    constexpr std::string_view no = "no ";
    std::size_t const end = text.find(' ');
    if (text.starts_with(no) || end == std::string_view::npos) {
        bool const holds = text.starts_with(no) ? !is_there(recipe, text.substr(no.size())) : is_there(recipe, text);
        return holds ? "" : std::string(text);
    }
    std::string_view const with = text.substr(end + 3);
    auto const value = value_in(recipe, text.substr(0, end));
    if (!value) {
        return std::string(text);
    }
    if (text[end + 1] == '=') {
        std::string const here = bare_text(*value);
        std::string const instead = begins_number(with) ? "" : fmt::format(" (here it is {})", in_quotes(here));
        return is_one_of(with, here) ? "" : std::string(text) + instead;
    }
    int limit = 0;
    std::from_chars(with.data(), with.data() + with.size(), limit);
    bool const holds = text[end + 1] == '>' ? number_of(*value) > limit : number_of(*value) < limit;
    return holds ? "" : std::string(text);
}

std::string lacking_of(Recipe const& recipe, std::string_view text) {
    for (bool const any : {true, false}) {
        std::vector<std::string_view> const parts = split_condition(text, any ? " or " : " and ");
        std::string lacking;
        for (std::size_t i = 0; i < parts.size() && parts.size() > 1; ++i) {
            std::string const lacks = lacking_of(recipe, parts[i]);
            if (any && lacks.empty()) {
                return "";
            }
            lacking += (lacking.empty() || lacks.empty() ? "" : any ? ", or " : " and ") + lacks;
        }
        if (parts.size() > 1) {
            return lacking;
        }
    }
    return text.starts_with('(') ? lacking_of(recipe, text.substr(1, text.size() - 2))
                                 : lacking_of_simple(recipe, text);
}

} // namespace

bool Use::holds(Recipe const& recipe) const {
    return lacks(recipe).empty();
}

std::string Use::lacks(Recipe const& recipe) const {
    if (test != nullptr || text.empty()) {
        return test == nullptr || test(recipe) ? "" : text;
    }
    return lacking_of(recipe, text);
}

} // namespace thalweg::recipe
