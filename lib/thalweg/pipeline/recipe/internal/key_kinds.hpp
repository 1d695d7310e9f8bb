// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

/// The kinds of keys a recipe has: each binds one to its field. Private to this room.
namespace thalweg::pipeline {

struct Range {
    double least;
    double most;
    bool open = false; ///< least itself is not allowed
    bool holds(double v) const { return std::isfinite(v) && (open ? v > least : v >= least) && v <= most; }
    std::string text() const;
    /// Throws BadParameter where the range does not hold the value.
    void require(double v) const;
};

inline constexpr double endless = 9.0e15;

double as_number(Value const& v);
std::int64_t as_integer(Value const& v);
std::string const& as_text(Value const& v);
/// Throws BadParameter: what is wanted, not the value.
[[noreturn]] void refuse(char const* wanted, Value const& v);
/// Throws BadParameter: the word is none of these.
[[noreturn]] void refuse_word(std::string const& word, std::vector<std::string> const& words);
/// "one | two | three"
std::string alternatives(std::vector<std::string> const& words);

/// Where a field lives: makes its section when a key is set, finds it (or nothing) when it is written.
template <class T> struct Field {
    std::function<T&(Recipe&)> make;
    std::function<T const*(Recipe const&)> find;
};

template <class T, class F> Field<T> in_recipe(F f) {
    return {[f](Recipe& r) -> T& { return f(r); },
            [f](Recipe const& r) -> T const* { return &f(const_cast<Recipe&>(r)); }};
}
/// A field of a section, which a recipe may leave out.
template <class T, class Part, class F> Field<T> in_part(std::optional<Part> Recipe::*part, F f) {
    return {[part, f](Recipe& r) -> T& {
                if (!(r.*part)) {
                    (r.*part).emplace();
                }
                return f(*(r.*part));
            },
            [part, f](Recipe const& r) -> T const* { return r.*part ? &f(const_cast<Part&>(*(r.*part))) : nullptr; }};
}
template <class T, class F> Field<T> in_network(F f) {
    return in_part<T>(&Recipe::network, f);
}
template <class T, class F> Field<T> in_skeleton(F f) {
    return in_part<T>(&Recipe::skeleton, f);
}
template <class T, class F> Field<T> in_surface(F f) {
    return in_part<T>(&Recipe::surface, f);
}
template <class T, class F> Field<T> in_statistics(F f) {
    return in_part<T>(&Recipe::statistics, f);
}
template <class T, class F> Field<T> in_detail(F f) {
    return in_part<T>(&Recipe::detail, f);
}

/// A field of the last patch.
template <class T, class F> Field<T> in_patch(F f) {
    return {[f](Recipe& r) -> T& {
                if (r.patches.empty()) {
                    r.patches.emplace_back();
                }
                return f(r.patches.back());
            },
            [f](Recipe const& r) -> T const* {
                return r.patches.empty() ? nullptr : &f(const_cast<PatchRecipe&>(r.patches.back()));
            }};
}

template <class T>
std::function<std::optional<Value>(Recipe const&)> taker(Field<T> field,
                                                         std::function<std::optional<Value>(T const&)> as) {
    return [field, as](Recipe const& r) -> std::optional<Value> {
        T const* const at = field.find(r);
        return at == nullptr ? std::nullopt : as(*at);
    };
}

Key number(char const* path, char const* unit, Range range, char const* meaning, Field<double> field);
/// A number that may be left out.
Key maybe(char const* path, char const* unit, Range range, char const* meaning, Field<std::optional<double>> field);
/// A side of the grid: 0 inside, never in a file, stands for "left out".
Key side(char const* path, char const* meaning, Field<std::int64_t> field);
Key text(char const* path, char const* range, char const* meaning, Field<std::string> field);
/// A key that names a file.
Key file(char const* path, char const* meaning, Field<std::string> field);
Key yes_no(char const* path, char const* meaning, Field<bool> field);

/// A list of numbers that may be left out.
template <class List>
Key numbers(char const* path, char const* type, char const* range, char const* unit, char const* meaning,
            Field<std::optional<List>> field, std::function<bool(List const&)> holds) {
    Key key;
    key.help = {path, type, range, unit, "", meaning};
    key.put = [field, holds, range](Recipe& r, Value const& v) {
        auto const* list = std::get_if<List>(&v);
        if (list == nullptr || !holds(*list)) {
            refuse(range, v);
        }
        field.make(r) = *list;
    };
    key.take = taker<std::optional<List>>(
        field, [](std::optional<List> const& x) { return x ? std::optional<Value>(*x) : std::nullopt; });
    return key;
}

template <class Int>
Key integer(char const* path, char const* unit, Range range, char const* meaning, Field<Int> field) {
    Key key;
    key.help = {path, "integer", range.text(), unit, "", meaning};
    key.put = [range, field](Recipe& r, Value const& v) {
        std::int64_t const x = as_integer(v);
        range.require(static_cast<double>(x));
        field.make(r) = static_cast<Int>(x);
    };
    key.take = taker<Int>(field, [](Int const& x) { return std::optional<Value>(static_cast<std::int64_t>(x)); });
    return key;
}

template <class Enum> using Choices = std::vector<std::pair<std::string, Enum>>;

template <class Enum> Key choice(char const* path, Choices<Enum> choices, char const* meaning, Field<Enum> field) {
    std::vector<std::string> words;
    for (auto const& [word, value] : choices) {
        words.push_back(word);
    }
    Key key;
    key.help = {path, "text", alternatives(words), "", "", meaning, words};
    key.put = [choices, words, field](Recipe& r, Value const& v) {
        std::string const& s = as_text(v);
        for (auto const& [word, value] : choices) {
            if (word == s) {
                field.make(r) = value;
                return;
            }
        }
        refuse_word(s, words);
    };
    key.take = taker<Enum>(field, [choices](Enum const& e) -> std::optional<Value> {
        for (auto const& [word, value] : choices) {
            if (value == e) {
                return word;
            }
        }
        return std::nullopt;
    });
    return key;
}

} // namespace thalweg::pipeline
