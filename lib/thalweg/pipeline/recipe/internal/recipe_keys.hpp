// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

// Conditions under which a key of a recipe has an effect.

/// A condition on a recipe, for the program and in words.
struct Use {
    std::string text; ///< `surface.method = "diffuse"`; "" holds for every recipe
    std::function<bool(Recipe const&)> holds;
    /// What a recipe lacks for it to hold and what it has instead; "" where it holds.
    std::function<std::string(Recipe const&)> lacks;
    enum class Kind { simple, both, either } kind = Kind::simple;
};

Use always();
/// A section that is there: "network", "statistics"; of an array, an item of it.
Use with(std::string const& section);
Use without(std::string const& section);
/// A key, left out or not, has one of these values, as they stand in a recipe file without quotes.
Use is(std::string const& path, std::vector<std::string> const& words);
/// A number is greater than this.
Use above(std::string const& path, double limit);
/// A key is given; a text is not "".
Use given(std::string const& path);
Use not_given(std::string const& path);
/// A condition of its own, in words.
Use when(std::string text, std::function<bool(Recipe const&)> holds);

Use operator&&(Use const& a, Use const& b);
Use operator||(Use const& a, Use const& b);

// The table of a recipe's keys.

using Pair = std::array<double, 2>;
using Triple = std::array<double, 3>;
using Quad = std::array<double, 4>;
using Value = std::variant<bool, std::int64_t, double, std::string, Pair, Triple, Quad>;

struct Range {
    double least;
    double most;
    bool open = false; ///< least itself is not allowed
    bool holds(double v) const { return std::isfinite(v) && (open ? v > least : v >= least) && v <= most; }
    std::string text() const;
    /// Throws BadParameter where the range does not hold the value.
    void require(double v) const;
};

/// A section of recipe files, [network] with what lies below it, or the keys before the first section.
struct Section {
    std::string name;                                ///< "network"; "" before the first section
    bool is_array = false;                           ///< [[patch]]: each mention is one more
    std::function<std::size_t(Recipe const&)> count; ///< how many a recipe has; what it cannot be without is 1
    std::function<void(Recipe&)> begin;              ///< makes it, or one more of an array
};

/// A key, bound to its field. Of a section that is an array, item counts from 0; without one the last is meant.
struct Key {
    KeyHelp help;
    Use use;                    ///< when it has an effect
    std::vector<Value> earlier; ///< defaults of earlier versions, which their recipe.toml files hold where unused
    std::string folder;         ///< of a file: where below inputs/ a copy of it lies, "mask/"
    std::optional<Range> range; ///< of a number
    Section const* part = nullptr;
    std::function<void(Value const&)> check;
    std::function<void(Recipe&, std::size_t, Value const&)> store;
    std::function<std::optional<Value>(Recipe const&, std::size_t)> show;
    std::function<std::string(Recipe const&, std::size_t)> layer; ///< of a file: the layer that is meant; "" for any

    /// Makes the section, or the item after the last, where it is not there.
    /// Throws: BadParameter with the reason alone; the recipe is unchanged then.
    void put(Recipe& recipe, Value const& value, std::optional<std::size_t> item = {}) const;
    /// Nothing where the section or the value is left out.
    std::optional<Value> take(Recipe const& recipe, std::optional<std::size_t> item = {}) const;
    /// "patch.2.rotate" of the second patch; the path of any other.
    std::string place(std::size_t item) const;
    /// What stands in its brackets in a recipe file: "network.dla".
    std::string section() const;
    std::string name() const;
};

/// A value as TOML writes it.
std::string toml_text(Value const& value);

/// A recipe in which every key of the table has its default: it has all sections, and one patch.
Recipe with_all_sections();

/// Every section in the order of recipe files.
std::vector<Section> const& all_sections();

/// Every key in the order of recipe files.
std::vector<Key> const& all_keys();

/// The section of a name, or nullptr.
Section const* find_section(std::string const& name);

/// The key of a path, or nullptr.
Key const* find_key(std::string const& path);

/// "unknown key 'network.prunes'", with the nearest one, or one of that name in another section.
std::string unknown_key(std::string const& path);

/// The first line of a TOML text, counted from 1, where values lie deeper than this many levels: sections, parts of
/// dotted keys, inline tables and arrays count one each. Strings and comments are left out; a text that is no TOML
/// gives some number. It is found without recursion, for parsers that recurse a level, and destructors that do.
std::optional<std::size_t> line_deeper_than(std::string_view toml, std::size_t most_levels);

} // namespace thalweg::pipeline
