// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

// Values of keys, and the fields of a recipe that hold them.

using Pair = std::array<double, 2>;
using Triple = std::array<double, 3>;
using Quad = std::array<double, 4>;
using WordList = std::vector<std::string>;
using Value = std::variant<bool, std::int64_t, double, std::string, Pair, Triple, Quad, WordList>;

/// A value as TOML writes it.
std::string toml_text(Value const& value);

/// An enumeration by the numbers of its enumerators; an optional one is -1 where there is none.
struct Enumeration {
    void* at;
    int (*get)(void const*);
    void (*set)(void*, int);
    int least = 0;
};

template <class E> Enumeration choice(E& field) {
    return {&field, [](void const* at) { return static_cast<int>(*static_cast<E const*>(at)); },
            [](void* at, int number) { *static_cast<E*>(at) = static_cast<E>(number); }};
}

template <class E> Enumeration choice(std::optional<E>& field) {
    using Optional = std::optional<E>;
    auto const get = [](void const* at) {
        Optional const& held = *static_cast<Optional const*>(at);
        return held ? static_cast<int>(*held) : -1;
    };
    auto const set = [](void* at, int number) {
        *static_cast<Optional*>(at) = number < 0 ? Optional() : Optional(static_cast<E>(number));
    };
    return {&field, get, set, -1};
}

using Field = std::variant<bool*, int*, std::int64_t*, std::uint64_t*, double*, std::string*, std::optional<double>*,
                           std::optional<Pair>*, std::optional<Triple>*, std::optional<Quad>*, Enumeration,
                           std::optional<std::vector<OutputFiles>>*>;

/// The field of a value of any type that keys have.
template <class T> Field field_at(T& value) {
    if constexpr (std::is_constructible_v<Field, T*>) {
        return &value;
    } else {
        return choice(value);
    }
}

/// The number in a field: of a yes or no 1 or 0, of an enumeration that of its enumerator; nothing where it is left
/// out or no number.
std::optional<double> number_in(Field const& field);

} // namespace thalweg::recipe
