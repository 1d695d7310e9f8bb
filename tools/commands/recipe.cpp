// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/commands/make.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/recipe/presets.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/recipe/stages.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"

namespace thalweg::tools {

namespace {

using recipe::KeyHelp;

std::string section_of(std::string const& path) {
    auto const dot = path.rfind('.');
    return dot == std::string::npos ? "" : path.substr(0, dot);
}

std::string key_name(std::string const& path) {
    return path.substr(path.rfind('.') + 1);
}

std::string without_brackets(std::string const& word) {
    auto const begin = word.find_first_not_of('[');
    auto const end = word.find_last_not_of(']');
    return begin == std::string::npos || end < begin ? word : word.substr(begin, end - begin + 1);
}

template <class Wanted> std::vector<KeyHelp> keys_where(std::vector<KeyHelp> const& keys, Wanted const& wanted) {
    std::vector<KeyHelp> found;
    std::copy_if(keys.begin(), keys.end(), std::back_inserter(found), wanted);
    return found;
}

/// The keys that a word selects: all for "", one for its path, all of a section for the section's name (with or without
/// brackets), or all with that name in any section. Throws BadParameter with a suggestion for another word.
std::vector<KeyHelp> keys_named(std::string const& word) {
    std::vector<KeyHelp> const all = recipe::recipe_keys();
    std::string const name = without_brackets(word);
    if (name.empty()) {
        return all;
    }
    std::vector<KeyHelp> found = keys_where(all, [&](KeyHelp const& key) { return key.path == name; });
    if (found.empty()) {
        found =
            keys_where(all, [&](KeyHelp const& key) { return (section_of(key.path) + ".").rfind(name + ".", 0) == 0; });
    }
    if (found.empty()) {
        found = keys_where(all, [&](KeyHelp const& key) { return key_name(key.path) == name; });
    }
    if (found.empty()) {
        std::vector<std::string> known;
        for (KeyHelp const& key : all) {
            known.push_back(key.path);
            known.push_back(section_of(key.path));
        }
        throw BadParameter("commands.recipe", fmt::format("unknown key '{}'.{} `thalweg recipe` lists every key.", word,
                                                          did_you_mean(name, known)));
    }
    return found;
}

/// Keys by section, with unit, range and default.
std::string keys_as_list(std::vector<KeyHelp> const& keys) {
    std::string text;
    std::string section = " ";
    for (KeyHelp const& key : keys) {
        if (section_of(key.path) != section) {
            section = section_of(key.path);
            text += text.empty() ? "" : "\n";
            text += section.empty()                     ? ""
                    : recipe::is_array_section(section) ? "[[" + section + "]]\n"
                                                        : "[" + section + "]\n";
        }
        text += fmt::format("{:<17} {}{}\n{:<18}{}; {}{}\n", key_name(key.path), key.meaning,
                            key.unit.empty() ? "" : " [" + key.unit + "]", "", key.type, key.range,
                            key.standard.empty() ? "" : "; default " + key.standard);
    }
    return text;
}

/// One key with all its attributes.
std::string key_as_text(KeyHelp const& key) {
    std::string text = key.path + "\n";
    auto const line = [&](char const* what, std::string const& words) {
        text += words.empty() ? "" : fmt::format("  {:<9} {}\n", what, words);
    };
    line("meaning", key.meaning);
    line("type", key.type);
    line("unit", key.unit);
    line("range", key.range);
    line("default", key.standard);
    line("used by", key.used_by);
    line("file", key.is_file ? "its value is a file name, relative to the recipe's folder" : "");
    return text;
}

/// The steps of make, in order.
nlohmann::ordered_json stages_as_json() {
    auto stages = nlohmann::ordered_json::array();
    for (recipe::Stage const* const stage : recipe::all_stages()) {
        stages.push_back({{"stage", stage->name},
                          {"runs_if", stage->runs_if()},
                          {"seconds_a_million_cells", stage->seconds_a_million},
                          {"bytes_a_cell", stage->bytes_a_cell}});
    }
    return stages;
}

/// One JSON object: "keys", an array of objects; of all keys, also "stages".
std::string keys_as_json(std::vector<KeyHelp> const& keys, bool with_stages) {
    nlohmann::ordered_json json{{"keys", nlohmann::ordered_json::array()}};
    for (KeyHelp const& key : keys) {
        json["keys"].push_back({{"key", key.path},
                                {"meaning", key.meaning},
                                {"type", key.type},
                                {"unit", key.unit},
                                {"range", key.range},
                                {"default", key.standard},
                                {"choices", key.choices},
                                {"used_by", key.used_by},
                                {"is_file", key.is_file}});
    }
    if (with_stages) {
        json["stages"] = stages_as_json();
    }
    return json.dump(2) + "\n";
}

void print_keys(std::string const& word, Session const& session) {
    std::vector<KeyHelp> const keys = keys_named(word);
    fmt::print("{}", session.json       ? keys_as_json(keys, word.empty())
                     : keys.size() == 1 ? key_as_text(keys.front())
                                        : keys_as_list(keys));
}

/// A paragraph each.
std::string presets_in_words() {
    std::string text;
    for (recipe::Preset const& preset : recipe::presets()) {
        text += fmt::format("  {}: {}. Not {}.\n", preset.name, preset.meaning, preset.not_meant);
    }
    return text;
}

} // namespace

Command add_recipe(CLI::App& app, Session& session) {
    auto const dump = std::make_shared<bool>(false);
    auto const rivers = std::make_shared<std::string>();
    auto const source_crs = std::make_shared<std::string>();
    auto const preset = std::make_shared<std::string>();
    auto const key = std::make_shared<std::string>();
    app.add_option("KEY", *key,
                   "Show this key, such as network.prune, or the keys of this section. Default: every key.");
    add_json_option(app, session);
    CLI::Option* const default_one = app.add_flag("--dump", *dump, "Print the default recipe as a TOML file.");
    CLI::Option* const of_preset =
        app.add_option("--preset", *preset, "Print the recipe of this preset as a TOML file; see below.")
            ->check(CLI::IsMember(preset_names()))
            ->excludes(default_one);
    CLI::Option* const of_rivers =
        app.add_option("--for", *rivers,
                       "Print the recipe that make uses for these rivers: a file of lines, or a folder written by make "
                       "or convert; or for this DEM.")
            ->type_name("FILE(gpkg,shp,geojson,json,fgb,kml,gpx,gdb,zip,tif,tiff,asc)")
            ->excludes(of_preset);
    app.add_option("--source-crs", *source_crs, "Read rivers whose file has no CRS in this one, as make does.")
        ->type_name("EPSG:N")
        ->needs(of_rivers);
    app.footer("Prints keys with their unit, range and default. thalweg-recipe(5) is the same as a manual page.\n\n"
               "Presets, which make takes too:\n" +
               presets_in_words() +
               "\n"
               "Examples:\n"
               "  thalweg recipe\n"
               "  thalweg recipe network.prune\n"
               "  thalweg recipe surface --json\n"
               "  thalweg recipe --dump > mine.toml\n"
               "  thalweg recipe --preset hills > hills.toml\n"
               "  thalweg recipe --for samples/walker_nhdplus.gpkg > walker.toml\n");
    return [dump, preset, rivers, source_crs, key, &session] {
        if (!preset->empty()) {
            fmt::print("{}", recipe::write_recipe(recipe::with_preset(recipe::default_recipe(), *preset)));
        } else if (!rivers->empty()) {
            fmt::print("{}", recipe::write_recipe(commands::recipe_for(*rivers, *source_crs, session.run)));
        } else if (*dump) {
            fmt::print("{}", recipe::write_recipe(recipe::default_recipe()));
        } else {
            print_keys(*key, session);
        }
        return static_cast<int>(Exit::done);
    };
}

} // namespace thalweg::tools
