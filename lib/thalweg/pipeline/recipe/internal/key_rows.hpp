// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

namespace thalweg::pipeline {

// What the tables of keys are written in: a row names a key, its field by a chain of member pointers, and all that is
// known of it.

inline constexpr bool left_open = true; ///< of a Range
inline constexpr double endless = 9.0e15;

double as_number(Value const& v);
std::int64_t as_integer(Value const& v);
bool as_yes_no(Value const& v);
std::string const& as_text(Value const& v);
/// Throws BadParameter where no file or screen could hold the text.
std::string const& as_short_text(Value const& v);
/// Throws BadParameter: what is wanted, not the value.
[[noreturn]] void refuse(std::string const& wanted, Value const& v);
/// Throws BadParameter: the word is none of these.
[[noreturn]] void refuse_word(std::string const& word, std::vector<std::string> const& words);
/// "one | two | three"
std::string alternatives(std::vector<std::string> const& words);

void remember(std::vector<Value>& values, double value);

/// A key of a section or of a part of one; its path is its name in there. Its functions take the address of a struct of
/// the type `holder`, which has the field.
struct PartKey {
    KeyHelp help;
    Use use = always();
    std::vector<Value> earlier;
    std::string folder;
    std::optional<Range> range;
    std::type_info const* holder = nullptr;
    std::function<void(Value const&)> check;
    std::function<void(void*, Value const&)> store;
    std::function<std::optional<Value>(void const*)> show;
    std::function<std::string(void const*)> layer;

    // Not inline: 130 rows copy them.
    PartKey();
    PartKey(PartKey const& other);
    PartKey(PartKey&& other) noexcept;
    PartKey& operator=(PartKey const& other);
    PartKey& operator=(PartKey&& other) noexcept;
    ~PartKey();

    /// Throws std::logic_error where the key's field lies in another type: the table is wrong.
    PartKey const& of(std::type_info const& type) const;
};

/// The same, of an S.
template <class S> struct KeyOf : PartKey {};

template <class S> using Rows = std::vector<KeyOf<S>>;

/// From the address of a struct to that of a field in it.
using ToField = std::function<void*(void*)>;

template <class T> struct IsOptional : std::false_type {};
template <class T> struct IsOptional<std::optional<T>> : std::true_type {};

template <class T> constexpr char const* type_of() {
    return std::is_same_v<T, bool>                                                 ? "yes/no"
           : std::is_integral_v<T>                                                 ? "integer"
           : std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>> ? "number"
           : std::is_same_v<T, std::optional<Pair>>                                ? "two numbers"
           : std::is_same_v<T, std::optional<Triple>>                              ? "three numbers"
           : std::is_same_v<T, std::optional<Quad>>                                ? "four numbers"
                                                                                   : "text";
}

template <class T> std::optional<Value> shown(T const& x) {
    if constexpr (IsOptional<T>::value) {
        return x ? std::optional<Value>(*x) : std::nullopt;
    } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
        return static_cast<std::int64_t>(x);
    } else {
        return x;
    }
}

template <class T> T number_in(Range const& range, Value const& v) {
    if constexpr (std::is_integral_v<T>) {
        std::int64_t const x = as_integer(v);
        range.require(static_cast<double>(x));
        return static_cast<T>(x);
    } else {
        double const x = as_number(v);
        range.require(x);
        return x;
    }
}

template <class T> using Choices = std::vector<std::pair<std::string, T>>;

/// A row of a table: a key that fills a T.
template <class T> class Row {
public:
    using Read = std::function<T(Value const&)>;
    using Show = std::function<std::optional<Value>(T const&)>;

    template <class S> Row(char const* name, T S::*member) : Row(name, typeid(S)) {
        to_field_ = [member](void* s) -> void* { return &(static_cast<S*>(s)->*member); };
    }
    template <class S, class Part> Row(char const* name, Part S::*part, T Part::*member) : Row(name, typeid(S)) {
        to_field_ = [part, member](void* s) -> void* { return &(static_cast<S*>(s)->*part.*member); };
    }

    Row& means(char const* meaning) {
        key_.help.meaning = meaning;
        return *this;
    }
    Row& unit(char const* unit) {
        key_.help.unit = unit;
        return *this;
    }
    /// When it has an effect; without this in every recipe that has the section.
    Row& used(Use const& use) {
        key_.use = use;
        return *this;
    }
    /// The default in words, where the value alone does not say it.
    Row& standard(char const* words) {
        key_.help.standard = words;
        return *this;
    }
    /// A default of earlier versions, or what a key that was left out came to.
    Row& earlier(double value) {
        remember(key_.earlier, value);
        return *this;
    }
    /// Of a number.
    Row& range(Range range) {
        key_.help.range = range.text();
        key_.range = range;
        return reads([range](Value const& v) { return number_in<T>(range, v); });
    }
    /// What a text is like, in words.
    Row& form(std::string const& words) {
        key_.help.range = words;
        return *this;
    }
    /// What a list of numbers is like, in words, and whether one is.
    template <class Holds> Row& form(char const* words, Holds holds) {
        key_.help.range = words;
        return reads([words, holds](Value const& v) -> T {
            auto const* list = std::get_if<typename T::value_type>(&v);
            if (list == nullptr || !holds(*list)) {
                refuse(words, v);
            }
            return *list;
        });
    }
    /// The words a text may be, and what each means.
    Row& one_of(Choices<T> const& choices) {
        std::vector<std::string> words;
        for (auto const& [word, value] : choices) {
            words.push_back(word);
        }
        key_.help.range = alternatives(words);
        suggests(words);
        shows([choices](T const& x) -> std::optional<Value> {
            for (auto const& [word, value] : choices) {
                if (value == x) {
                    return word;
                }
            }
            return std::nullopt;
        });
        return reads([choices, words](Value const& v) -> T {
            std::string const& text = as_text(v);
            for (auto const& [word, value] : choices) {
                if (word == text) {
                    return value;
                }
            }
            refuse_word(text, words);
        });
    }
    /// Words that completion offers.
    Row& suggests(std::vector<std::string> const& words) {
        key_.help.choices = words;
        return *this;
    }
    /// Refuses more than its kind does, and does so first: throws BadParameter.
    Row& checked(std::function<void(Value const&)> const& check) {
        return reads([check, read = read_](Value const& v) {
            check(v);
            return read(v);
        });
    }
    /// The field says by 0 that the key is left out.
    Row& left_out_at_zero() {
        return shows([](T const& x) { return x == T{} ? std::nullopt : shown(x); });
    }
    /// Of a file: the key of its layer.
    template <class S> Row& layer(std::string S::*member) {
        key_.of(typeid(S));
        key_.layer = [member](void const* s) { return static_cast<S const*>(s)->*member; };
        return *this;
    }
    /// Of a file: where below inputs/ a copy of it lies, in place of a folder of the key's name.
    Row& kept_in(char const* folder) {
        key_.folder = folder;
        return *this;
    }
    Row& names_a_file() {
        key_.help.is_file = true;
        return kept_in((key_.help.path + "/").c_str()).form("file name");
    }

    Row& type(char const* words) {
        key_.help.type = words;
        return *this;
    }
    Row& reads(Read read) {
        read_ = std::move(read);
        key_.check = [r = read_](Value const& v) { r(v); };
        key_.store = [r = read_, to = to_field_](void* s, Value const& v) { *static_cast<T*>(to(s)) = r(v); };
        return *this;
    }
    Row& shows(Show show) {
        key_.show = [show = std::move(show), to = to_field_](void const* s) {
            return show(*static_cast<T const*>(to(const_cast<void*>(s))));
        };
        return *this;
    }

    template <class S> operator KeyOf<S>() const { return {key_.of(typeid(S))}; }

private:
    Row(char const* name, std::type_info const& holder) {
        key_.holder = &holder;
        key_.help.path = name;
        key_.help.type = type_of<T>();
    }

    PartKey key_;
    ToField to_field_;
    Read read_;
};

template <class S, class T> Row(char const*, T S::*) -> Row<T>;
template <class S, class Part, class T> Row(char const*, Part S::*, T Part::*) -> Row<T>;

/// A row whose value is written as it is held; a field that is optional may be left out.
template <class... Members> auto plain(char const* name, Members... members) {
    return Row(name, members...).shows([](auto const& x) { return shown(x); });
}

/// A number, or an integer, with a range.
template <class... Members> auto number(char const* name, Members... members) {
    return plain(name, members...);
}

/// A list of numbers that may be left out.
template <class... Members> auto numbers(char const* name, Members... members) {
    return plain(name, members...);
}

template <class... Members> auto text(char const* name, Members... members) {
    return plain(name, members...).reads(as_short_text);
}

/// A text that names a file.
template <class... Members> auto file(char const* name, Members... members) {
    return text(name, members...).names_a_file();
}

template <class... Members> auto yes_no(char const* name, Members... members) {
    return plain(name, members...).reads(as_yes_no).form("true | false").suggests({"true", "false"});
}

/// One of several words.
template <class... Members> auto choice(char const* name, Members... members) {
    return Row(name, members...);
}

/// A key of a part as a key of the whole. prefix: of its name, "dla."
PartKey inside(std::string const& prefix, std::type_info const& whole, ToField const& to_part, PartKey const& row);

template <class S, class Part> Rows<S> inside(std::string const& prefix, Part S::*part, Rows<Part> const& rows) {
    ToField const to_part = [part](void* s) -> void* { return &(static_cast<S*>(s)->*part); };
    Rows<S> keys;
    for (KeyOf<Part> const& row : rows) {
        keys.push_back({inside(prefix, typeid(S), to_part, row)});
    }
    return keys;
}

template <class S> Rows<S> joined(std::vector<Rows<S>> const& parts) {
    Rows<S> all;
    for (Rows<S> const& rows : parts) {
        all.insert(all.end(), rows.begin(), rows.end());
    }
    return all;
}

// Conditions that keys of several sections share: what the stages read, and when.

Use source_is(char const* word);

/// Terrain around rivers by one of these methods.
Use method_is(std::vector<std::string> const& words);
Use by_equilibrium();
Use has_surface();

// The keys of each section and of its parts, in the order of recipe files.

Rows<Recipe> seed_keys();
Rows<GridRecipe> grid_keys();
Rows<NetworkRecipe> network_keys();
Rows<SkeletonRecipe> skeleton_keys();
Rows<SurfaceRecipe> surface_keys();
Rows<StatisticsRecipe> statistics_keys();
Rows<DetailRecipe> detail_keys();
Rows<PatchRecipe> patch_keys();
Rows<OutputRecipe> output_keys();

} // namespace thalweg::pipeline
