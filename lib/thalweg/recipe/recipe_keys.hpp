// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <thalweg/core/run/error.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/recipe/recipe_fields.hpp>

namespace thalweg::recipe {

// Rows of the table.

enum class KeyKind : std::uint8_t {
    yes_no,
    integer,
    number,
    pair,
    triple,
    quad,
    text,
    file,
    word,
    integer_or_word,
    words
};

inline constexpr bool left_open = true; ///< of a KeyRange
inline constexpr double endless = 9.0e15;

struct KeyRange {
    double least = 0.0;
    double most = 0.0;
    bool open = false; ///< least itself is not allowed
    bool holds(double v) const { return std::isfinite(v) && (open ? v > least : v >= least) && v <= most; }
    std::string text() const;
};

/// A word of an enumeration. Without an enumerator those of a row stand in the order of the enumeration.
struct Word {
    char const* text = nullptr;
    std::optional<int> number = {};
    constexpr Word() = default;
    constexpr Word(char const* word) : text(word) {}
    constexpr Word(char const* word, std::nullopt_t) : text(word), number(-1) {}
    template <class E> constexpr Word(char const* word, E of) : text(word), number(static_cast<int>(of)) {}
};

/// What a value may be: a number in a range, one of several words, or what a form says.
struct AllowedValues {
    KeyRange range = {};
    char const* form = "";                ///< in words
    bool (*fits)(Value const&) = nullptr; ///< false, or an error of its own: refused
    std::array<Word, 10> words = {};
    std::vector<std::string> (*more_words)() = nullptr; ///< those that another table has

    constexpr AllowedValues() = default;
    constexpr AllowedValues(double least, double most, bool open = false) : range{least, most, open} {}
    constexpr AllowedValues(char const* of_form, bool (*test)(Value const&) = nullptr) : form(of_form), fits(test) {}
    constexpr AllowedValues(std::vector<std::string> (*of)(), char const* of_form = "",
                            bool (*test)(Value const&) = nullptr)
        : form(of_form), fits(test), more_words(of) {}
    constexpr AllowedValues(std::initializer_list<Word> of) { std::copy(of.begin(), of.end(), words.begin()); }
};

/// What few keys have.
struct Extra {
    char const* standard = "";                         ///< the default in words, where the value alone does not say it
    std::array<std::optional<double>, 2> earlier = {}; ///< defaults of earlier versions, or what a key left out came to
    bool left_out_at_zero = false;                     ///< the field says by 0 that the key is left out
    char const* layer = nullptr;                       ///< of a file: the key of its layer
    char const* folder = nullptr; ///< of a file: where below inputs/ a copy lies; null: folder of its name
};

using Item = std::size_t; ///< of a section that is an array, counted from 0

/// A key and all that is known of it.
struct Row {
    char const* path;
    KeyKind kind;
    char const* unit;
    AllowedValues allowed;
    Condition used; ///< when it has an effect, in a recipe that has the section
    char const* meaning;
    Field (*field)(Recipe&, Item);
    Extra extra;
};

/// Every key in the order of recipe files, section by section.
std::span<Row const> recipe_rows();

/// The row whose key is held by a field of a sample recipe, and that field.
struct FoundRow {
    Row const& row;
    Field field;
};
FoundRow row_of(Condition::FieldOf const& field);

/// The words that a key may be, and the enumerators they stand for.
std::vector<std::pair<std::string, int>> words_of(Row const& row, Field const& field);

// Keys, as the rows of the table make them.

/// A section of recipe files, [network] with what lies below it, or the keys before the first section.
struct Section {
    std::string_view name;                   ///< "network"; "" before the first section
    std::size_t (*count)(Recipe const&);     ///< how many a recipe has; what it cannot be without is 1
    void (*begin)(Recipe&);                  ///< makes it, or one more of an array
    void (*remove)(Recipe&, Item) = nullptr; ///< takes it out; null: no recipe is without it
    bool is_array = false;                   ///< [[patch]]: each mention is one more
};

/// A key. Of a section that is an array, item counts from 0; without one the last is meant.
struct Key {
    Row const* row = nullptr;
    Section const* part = nullptr;
    KeyHelp help;
    Condition use;                 ///< when it has an effect
    std::optional<KeyRange> range; ///< of a number
    std::vector<int> numbers;      ///< by word of help.choices: the enumerator it stands for
    std::string folder;            ///< of a file: where below inputs/ a copy of it lies, "mask/"

    /// Makes the section, or the item after the last, where it is not there.
    /// \throws BadParameter with the reason alone; the recipe is unchanged then
    void put(Recipe& recipe, Value const& value, std::optional<Item> item = {}) const;
    /// Takes it back to its default, in a section that is there.
    void reset(Recipe& recipe, Item item) const;
    /// Nothing where the section or the value is left out.
    std::optional<Value> take(Recipe const& recipe, std::optional<Item> item = {}) const;
    /// "patch.2.rotate" of the second patch; the path of any other.
    std::string place(Item item) const;
    /// What stands in its brackets in a recipe file: "network.dla".
    std::string section() const;
    std::string name() const;
};

/// Calls a function, and puts a key of the recipe in front of what it finds wrong.
/// \param key "[grid] crs"
template <class Work> auto naming_key(std::string const& key, Work const& work) {
    try {
        return work();
    } catch (BadParameter const& fault) {
        throw BadParameter(fault.where(), key + ": " + fault.what());
    } catch (BadInput const& fault) {
        throw BadInput(fault.where(), key + ": " + fault.what());
    }
}

/// A recipe in which every key of the table has its default: it has all sections, and one patch.
Recipe with_all_sections();

/// Every section in the order of recipe files.
std::span<Section const> all_sections();

/// Every key in the order of recipe files.
std::vector<Key> const& all_keys();

/// The section of a name, or nullptr.
Section const* find_section(std::string_view name);

/// The key of a path, or nullptr.
Key const* find_key(std::string_view path);

/// "unknown key 'network.prunes'", with the nearest one, or one of that name in another section.
std::string unknown_key(std::string const& path);

/// The first line of a TOML text, counted from 1, where values lie deeper than this many levels: sections, parts of
/// dotted keys, inline tables and arrays count one each. Strings and comments are left out; a text that is no TOML
/// gives some number. It is found without recursion, for parsers that recurse a level, and destructors that do.
std::optional<std::size_t> line_deeper_than(std::string_view toml, std::size_t most_levels);

} // namespace thalweg::recipe
