// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/recipe.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>
#include <thalweg/pipeline/recipe/internal/toml_entries.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace thalweg::pipeline {

namespace {

constexpr std::size_t most_faults = 20;

/// Whether keys stand in brackets of this path or below it.
bool has_keys(std::string const& path) {
    return std::any_of(all_keys().begin(), all_keys().end(),
                       [&](Key const& key) { return (key.section() + ".").starts_with(path + "."); });
}

/// The section that brackets of this path belong to, or nullptr.
Section const* section_of(std::string const& path) {
    return has_keys(path) ? find_section(path.substr(0, path.find('.'))) : nullptr;
}

/// Puts the entries of a file into a recipe and collects what is wrong with them.
class Reader {
public:
    explicit Reader(std::string name) : name_(std::move(name)) {}

    Recipe read(std::vector<TomlEntry> const& entries) {
        for (std::size_t i = 0; i < entries.size() && faults_.size() < most_faults;) {
            bool const is_known = read(entries[i]);
            std::size_t const depth = entries[i].depth;
            ++i;
            while (!is_known && i < entries.size() && entries[i].depth > depth) {
                ++i;
            }
        }
        if (!faults_.empty()) {
            throw BadParameter(
                fmt::format("pipeline.read_recipe: {}: {}", name_, fmt::join(faults_, fmt::format("\n{}: ", name_))));
        }
        return recipe_;
    }

private:
    /// Gives whether what lies in it can be read.
    bool read(TomlEntry const& entry) {
        using Kind = TomlEntry::Kind;
        Section const* const section = section_of(entry.path);
        bool const is_array = section != nullptr && section->is_array && section->name == entry.path;
        if (entry.kind == Kind::tables && is_array) {
            return true; // each item begins one
        }
        if (entry.kind == Kind::value || entry.kind == Kind::tables) {
            put(entry);
            return false;
        }
        if (section == nullptr) {
            refuse(entry, unknown_key(cut(entry.path)));
            return false;
        }
        section->begin(recipe_);
        return true;
    }

    void put(TomlEntry const& entry) {
        Key const* const key = find_key(entry.path);
        if (key == nullptr) {
            refuse(entry, unknown_key(cut(entry.path)));
            return;
        }
        try {
            if (!entry.value) {
                throw BadParameter(fmt::format("its value has the wrong type; required: {}", key->help.type));
            }
            key->put(recipe_, *entry.value);
            recipe_.set_at[key->place(key->part->count(recipe_) - 1)] = fmt::format("{}, line {}", name_, entry.line);
        } catch (BadParameter const& fault) {
            refuse(entry, fmt::format("{}: {}", entry.path, fault.what()));
        }
    }

    void refuse(TomlEntry const& entry, std::string const& words) {
        faults_.push_back(fmt::format("line {}: {}", entry.line, words));
    }

    std::string name_;
    Recipe recipe_;
    std::vector<std::string> faults_;
};

} // namespace

Recipe read_recipe(std::string const& toml, std::string const& name) {
    return Reader(name).read(toml_entries(toml, name));
}

} // namespace thalweg::pipeline
