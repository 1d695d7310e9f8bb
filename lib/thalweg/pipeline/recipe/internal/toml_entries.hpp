// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

/// Recipe files as TOML. Private to this module.
namespace thalweg::pipeline {

/// What stands at one place of a TOML text.
struct TomlEntry {
    enum class Kind : std::uint8_t {
        value,
        table,  ///< its entries follow, one deeper
        tables, ///< an array of them: its items follow, one deeper
        item    ///< one of these: its entries follow, one deeper
    };
    Kind kind = Kind::value;
    std::string path; ///< "network.dla.particles"
    std::size_t depth = 0;
    std::int64_t line = 0;      ///< from 1
    std::optional<Value> value; ///< none where it is of no type that a key has
};

/// The entries of a TOML text, those of a table in the order of their words. name: for messages.
/// Throws: BadParameter when it is no TOML, or larger or deeper than a recipe may be.
std::vector<TomlEntry> toml_entries(std::string const& toml, std::string const& name);

/// What a text means as a value of TOML; the text itself where it is none.
/// Throws: BadParameter when it is an integer that TOML does not have.
Value value_in_toml(std::string const& text);

/// A word of a file as a message shows it: its beginning, where it is long.
std::string cut(std::string_view s);

} // namespace thalweg::pipeline
