// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <thalweg/pipeline/recipe/internal/key_use.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

/// The table of a recipe's keys. Private to this room.
namespace thalweg::pipeline {

using Pair = std::array<double, 2>;
using Triple = std::array<double, 3>;
using Quad = std::array<double, 4>;
using Value = std::variant<bool, std::int64_t, double, std::string, Pair, Triple, Quad>;

/// A key, bound to its field. put throws BadParameter with the reason alone; take gives nothing where the value is
/// unset.
struct Key {
    KeyHelp help;
    std::function<void(Recipe&, Value const&)> put;
    std::function<std::optional<Value>(Recipe const&)> take;
    Use use = {}; ///< when it has an effect
    std::string section() const {
        auto const dot = help.path.rfind('.');
        return dot == std::string::npos ? "" : help.path.substr(0, dot);
    }
    std::string name() const { return help.path.substr(help.path.rfind('.') + 1); }
};

/// Whether the value is the name of a file.
bool names_file(Key const& key);

/// A value as TOML writes it.
std::string toml_text(Value const& value);

/// A recipe in which every key of the table has its default: it has all sections, and one patch.
Recipe with_all_sections();

/// Every key in the order of recipe files. Those of [[patch]] read and write the last patch.
std::vector<Key> const& all_keys();

/// The key of a path, or nullptr.
Key const* find_key(std::string const& path);

} // namespace thalweg::pipeline
