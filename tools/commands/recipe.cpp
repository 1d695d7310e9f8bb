// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/pipeline/plan/make_input.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

#include "commands/commands.hpp"
#include "help/print_keys.hpp"

namespace thalweg::tools {

namespace {

int print_keys(std::string const& word, Session const& session) {
    std::vector<pipeline::KeyHelp> const keys = keys_named(word);
    fmt::print("{}", session.json       ? keys_as_json(keys)
                     : keys.size() == 1 ? key_as_text(keys.front())
                                        : keys_as_list(keys));
    return Exit::done;
}

int print_for(std::string const& rivers, std::string const& source_crs, Session const& session) {
    refuse_if<BadInput>(!is_utf8(std::filesystem::absolute(rivers).string()),
                        "the path of {} is not UTF-8, and recipes are: rename it", rivers);
    pipeline::Recipe recipe = pipeline::rivers_recipe(rivers);
    if (!source_crs.empty()) {
        pipeline::set_key(recipe, "network.lines.source_crs=" + source_crs);
    }
    fmt::print("{}", pipeline::write_recipe(pipeline::settled_recipe(recipe, session.run)));
    return Exit::done;
}

} // namespace

Command add_recipe(CLI::App& app, Session& session) {
    auto const dump = std::make_shared<bool>(false);
    auto const rivers = std::make_shared<std::string>();
    auto const source_crs = std::make_shared<std::string>();
    auto const key = std::make_shared<std::string>();
    app.add_option("KEY", *key,
                   "Show this key, such as network.prune, or the keys of this section. Default: every key.");
    app.add_flag("--json", session.json, "Print one JSON object.");
    app.add_flag("--dump", *dump, "Print the default recipe as a TOML file.");
    CLI::Option* const of_rivers =
        app.add_option("--for", *rivers,
                       "Print the recipe that make uses for these rivers: a file of lines, or a folder written by make "
                       "or convert.")
            ->type_name("FILE(gpkg,shp,geojson,json,fgb,kml,gpx,gdb,zip)");
    app.add_option("--source-crs", *source_crs, "Read rivers whose file has no CRS in this one, as make does.")
        ->type_name("EPSG:N")
        ->needs(of_rivers);
    app.footer("Prints keys with their unit, range and default. thalweg-recipe(5) is the same as a manual page.\n\n"
               "Examples:\n"
               "  thalweg recipe\n"
               "  thalweg recipe network.prune\n"
               "  thalweg recipe surface --json\n"
               "  thalweg recipe --dump > mine.toml\n"
               "  thalweg recipe --for samples/walker_nhdplus.gpkg > walker.toml\n");
    return [dump, rivers, source_crs, key, &session] {
        if (!rivers->empty()) {
            return print_for(*rivers, *source_crs, session);
        }
        if (*dump) {
            fmt::print("{}", pipeline::write_recipe(pipeline::default_recipe()));
            return static_cast<int>(Exit::done);
        }
        return print_keys(*key, session);
    };
}

} // namespace thalweg::tools
