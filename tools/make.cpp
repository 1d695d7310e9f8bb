// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "network_options.hpp"
#include "terminal.hpp"

#include <thalweg/io/files.hpp>
#include <thalweg/pipeline/make_input.hpp>
#include <thalweg/pipeline/recipe.hpp>
#include <thalweg/pipeline/report.hpp>
#include <thalweg/pipeline/terrain.hpp>
#include <thalweg/pipeline/write_terrain.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::tools {

namespace {

struct Options {
    std::string input;
    std::string folder = "valley";
    std::vector<std::string> set;
    std::optional<std::uint64_t> seed;
    std::string crs;
    std::string units;
    std::string schema;
    bool overwrite = false;
};

pipeline::Recipe recipe_of(Options const& options) {
    pipeline::Recipe recipe = options.input.empty() ? pipeline::default_recipe() : pipeline::recipe_from(options.input);
    for (std::string const& assignment : options.set) {
        pipeline::set_key(recipe, assignment);
    }
    if (options.seed) {
        pipeline::set_key(recipe, fmt::format("seed={}", *options.seed));
    }
    if (!options.crs.empty()) {
        pipeline::set_key(recipe, "grid.crs=" + options.crs);
    }
    if (!options.units.empty()) {
        pipeline::set_key(recipe, "output.units=" + options.units);
    }
    if (!options.schema.empty()) {
        pipeline::set_key(recipe, fmt::format("output.schema={}", options.schema));
    }
    return recipe;
}

int make(Options const& options, Session const& session) {
    auto const existing = options.overwrite ? io::Existing::replace : io::Existing::refuse;
    pipeline::Recipe const recipe = recipe_of(options);
    pipeline::check_folder(options.folder, existing);
    pipeline::Terrain const terrain = pipeline::make_terrain(recipe, session.run);
    pipeline::write_terrain(terrain, options.folder, existing, session.run);
    for (Check const& check : terrain.checks) {
        if (!check.ok) {
            session.run.say(fmt::format("check  {}: {} (at most {})  {}", check.name, check.value, check.limit,
                                        toned(Tone::bad, "FAILED", stderr)));
        }
    }
    if (terrain.passed()) {
        std::string words = fmt::format("{} checks", terrain.checks.size());
        if (terrain.recipe.network) {
            std::size_t const outlets = NetworkIndex(terrain.network.plan).outlets.size();
            words += fmt::format(", {} outlet{}", outlets, outlets == 1 ? "" : "s");
        }
        if (terrain.surface) {
            words += fmt::format(", {} cells in pits", terrain.pits);
        }
        session.run.say(fmt::format("check  {:<60}      {}", words, toned(Tone::good, "ok", stderr)));
    }
    session.run.say(
        fmt::format("open   {}   (no internet needed)", toned(Tone::name, options.folder + "/report.html", stderr)));
    fmt::print("{}", session.json ? io::read_text(options.folder + "/report.json", 1 << 30) : options.folder + "\n");
    return terrain.passed() ? Exit::done : Exit::check_failed;
}

} // namespace

Command add_make(CLI::App& app, Session& session) {
    auto const options = std::make_shared<Options>();
    app.add_option("INPUT", options->input,
                   "A recipe (TOML); or rivers: any file of lines that GDAL reads, or the folder that make or convert "
                   "wrote. Without it, thalweg grows a valley on 1024x1024 cells.")
        ->type_name("FILE(toml,gpkg,shp,geojson,json,fgb,kml,gpx,gdb,zip)");
    app.add_option("-o,--output", options->folder, "Write into this folder.")->type_name("DIR")->capture_default_str();
    app.add_option("--set", options->set,
                   "Set a key of the recipe, over what the file says. May be given many times; the last holds. Names "
                   "of files are relative to the current folder.")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--seed", options->seed, "Set the seed of every chance: the same as --set seed=N.");
    app.add_option("--crs", options->crs,
                   "Make the terrain in this coordinate system, projected in metres: the same as --set grid.crs=CRS.")
        ->type_name("EPSG:N");
    app.add_option("--units", options->units,
                   "Write heights in metres or in international feet (dem.tif, networks, contours, TINs): the same as "
                   "--set output.units=UNIT. Lengths stay in m, areas in m2.")
        ->check(CLI::IsMember({"m", "ft"}));
    app.add_option("--schema", options->schema,
                   "Write the rivers in the words of this schema too, as network_SCHEMA.gpkg: the same as --set "
                   "output.schema=SCHEMA.")
        ->check(CLI::IsMember(schema_names()));
    app.add_flag("--json", session.json, "Print report.json to stdout instead of the folder's name.");
    app.add_flag("--overwrite", options->overwrite,
                 "Replace what an earlier make left in the folder. Files of others stay.");
    app.footer("Rivers are grown, or read from a file of lines; they get heights, and the land is drawn around them. "
               "All that decides the result is in the recipe: the same recipe gives the same bytes on any machine. "
               "The folder appears whole or not at all.\n\n"
               "Rivers need no recipe: thalweg chooses the grid and its cell size from the data and makes terrain in "
               "equilibrium with them. thalweg recipe --for RIVERS prints the recipe that it uses. Of a folder that "
               "make or convert wrote it takes the arcs.\n\n"
               "Examples:\n"
               "  thalweg make\n"
               "  thalweg make samples/dla.toml --seed 8 --set network.prune=40 -o out/sparse\n"
               "  thalweg make out/sparse/recipe.toml -o out/again\n"
               "  thalweg make samples/walker_nhdplus.gpkg -o out/walker\n"
               "  thalweg make samples/walker_nhdplus.gpkg --crs EPSG:26910 --set grid.cell=30 -o out/utm\n"
               "  thalweg make out/walker --seed 8 -o out/other\n");
    return [options, &session] { return make(*options, session); };
}

} // namespace thalweg::tools
