// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

#include <thalweg/pipeline/make_input.hpp>
#include <thalweg/pipeline/recipe.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

namespace thalweg::tools {

namespace {

int print_keys() {
    std::string section = " ";
    for (pipeline::KeyHelp const& key : pipeline::recipe_keys()) {
        auto const dot = key.path.rfind('.');
        std::string const its_section = dot == std::string::npos ? "" : key.path.substr(0, dot);
        if (its_section != section) {
            section = its_section;
            fmt::print("{}{}", section.empty() ? "" : "\n",
                       section.empty()      ? ""
                       : section == "patch" ? "[[patch]]\n"
                                            : "[" + section + "]\n");
        }
        fmt::print("{:<18}{}{}\n{:<18}{}; {}{}\n", key.path.substr(dot == std::string::npos ? 0 : dot + 1), key.meaning,
                   key.unit.empty() ? "" : " [" + key.unit + "]", "", key.type, key.range,
                   key.standard.empty() ? "" : "; default " + key.standard);
    }
    return Exit::done;
}

int print_for(std::string const& rivers, Session const& session) {
    pipeline::Recipe const recipe = pipeline::settled_recipe(pipeline::rivers_recipe(rivers), session.run);
    fmt::print("{}", pipeline::write_recipe(recipe));
    return Exit::done;
}

} // namespace

Command add_recipe(CLI::App& app, Session& session) {
    auto const dump = std::make_shared<bool>(false);
    auto const rivers = std::make_shared<std::string>();
    app.add_flag("--dump", *dump, "Print the recipe that make uses without one, as a file to begin with.");
    app.add_option("--for", *rivers,
                   "Print the recipe that make uses for these rivers: a file of lines, or the folder that make or "
                   "convert wrote.")
        ->type_name("FILE(gpkg,shp,geojson,json,fgb,kml,gpx,gdb,zip)");
    app.footer("Each key with its unit, range and default. thalweg-recipe(5) is the same as a manual page.\n\n"
               "Examples:\n"
               "  thalweg recipe\n"
               "  thalweg recipe --dump > mine.toml\n"
               "  thalweg recipe --for samples/walker_nhdplus.gpkg > walker.toml\n");
    return [dump, rivers, &session] {
        if (!rivers->empty()) {
            return print_for(*rivers, session);
        }
        if (*dump) {
            fmt::print("{}", pipeline::write_recipe(pipeline::default_recipe()));
            return static_cast<int>(Exit::done);
        }
        return print_keys();
    };
}

} // namespace thalweg::tools
