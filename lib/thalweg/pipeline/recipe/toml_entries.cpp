// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/toml_entries.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/pipeline/recipe/internal/toml_depth.hpp>

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

namespace thalweg::pipeline {

namespace {

std::optional<Value> value_of_array(toml::array const& array) {
    std::vector<double> list;
    for (toml::node const& one : array) {
        if (auto const x = one.value<double>()) {
            list.push_back(*x);
        }
    }
    if (list.size() != array.size()) {
        return std::nullopt;
    }
    switch (list.size()) {
    case 2: return Pair{list[0], list[1]};
    case 3: return Triple{list[0], list[1], list[2]};
    case 4: return Quad{list[0], list[1], list[2], list[3]};
    default: return std::nullopt;
    }
}

std::optional<Value> value_of(toml::node const& node) {
    if (auto const* b = node.as_boolean()) {
        return b->get();
    }
    if (auto const* i = node.as_integer()) {
        return i->get();
    }
    if (auto const* d = node.as_floating_point()) {
        return d->get();
    }
    if (auto const* s = node.as_string()) {
        return s->get();
    }
    auto const* a = node.as_array();
    return a == nullptr ? std::nullopt : value_of_array(*a);
}

constexpr char const* too_large = "an integer of a recipe is at most 9223372036854775807";

bool is_too_large(toml::parse_error const& fault) {
    return fault.description().find("decimal integer") != std::string_view::npos &&
           fault.description().find("not representable") != std::string_view::npos;
}

// toml++ 3.3 recurses once a dotted part and level, also when it gives the memory back: sizes and depth are measured
// before it sees the text.
void require_modest(std::string const& toml, std::string const& name) {
    constexpr std::size_t most_bytes = 1 << 20;
    constexpr std::size_t longest_line = 8192;
    if (toml.size() > most_bytes) {
        throw BadParameter(fmt::format("pipeline.read_recipe: {}: a recipe has at most {} bytes, this has {}", name,
                                       most_bytes, toml.size()));
    }
    for (std::size_t begin = 0, line = 1; begin < toml.size(); ++line) {
        std::size_t const end = std::min(toml.find('\n', begin), toml.size());
        if (end - begin > longest_line) {
            throw BadParameter(
                fmt::format("pipeline.read_recipe: {}: line {} is longer than {} bytes", name, line, longest_line));
        }
        begin = end + 1;
    }
    constexpr std::size_t most_levels = 32;
    if (auto const line = line_deeper_than(toml, most_levels)) {
        throw BadParameter(
            fmt::format("pipeline.read_recipe: {}: line {}: keys, tables and arrays are nested more than {} "
                        "levels deep; no key of a recipe is",
                        name, *line, most_levels));
    }
}

void append(toml::table const& table, std::string const& prefix, std::size_t depth, std::vector<TomlEntry>& entries) {
    using Kind = TomlEntry::Kind;
    for (auto const& [word, node] : table) {
        std::string const path = prefix + std::string(word.str());
        std::int64_t const line = node.source().begin.line;
        if (auto const* inner = node.as_table()) {
            entries.push_back({Kind::table, path, depth, line, std::nullopt});
            append(*inner, path + ".", depth + 1, entries);
            continue;
        }
        auto const* list = node.as_array();
        if (list == nullptr || !list->is_homogeneous<toml::table>()) {
            entries.push_back({Kind::value, path, depth, line, value_of(node)});
            continue;
        }
        entries.push_back({Kind::tables, path, depth, line, std::nullopt});
        for (toml::node const& one : *list) {
            entries.push_back({Kind::item, path, depth + 1, line, std::nullopt});
            append(*one.as_table(), path + ".", depth + 2, entries);
        }
    }
}

} // namespace

std::vector<TomlEntry> toml_entries(std::string const& toml, std::string const& name) {
    require_modest(toml, name);
    toml::table table;
    try {
        table = toml::parse(toml, name);
    } catch (toml::parse_error const& fault) {
        bool const is_large = is_too_large(fault);
        throw BadParameter(fmt::format("pipeline.read_recipe: {}: line {}, column {}: {}", name,
                                       fault.source().begin.line, fault.source().begin.column,
                                       is_large ? too_large : cut(fault.description())));
    }
    std::vector<TomlEntry> entries;
    append(table, "", 0, entries);
    return entries;
}

Value value_in_toml(std::string const& text) {
    try {
        toml::table const table = toml::parse("v = " + text);
        return value_of(*table.get("v")).value_or(Value(text));
    } catch (toml::parse_error const& fault) {
        if (is_too_large(fault)) {
            throw BadParameter(too_large);
        }
        return text; // the key says what is wanted instead
    }
}

std::string cut(std::string_view s) {
    return s.size() <= 80 ? std::string(s) : std::string(s.substr(0, 77)) + "...";
}

} // namespace thalweg::pipeline
