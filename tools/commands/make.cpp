// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/pipeline/make/make.hpp>
#include <thalweg/pipeline/plan/make_input.hpp>
#include <thalweg/pipeline/plan/plan.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>
#include <thalweg/pipeline/recipe/recipe_files.hpp>
#include <thalweg/pipeline/report/report.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/verdict.hpp"
#include "terminal/terminal.hpp"

namespace thalweg::tools {

namespace {

std::string time_in_words(double seconds) {
    double const rounded = std::max(1.0, std::ceil(seconds));
    return rounded < 120.0 ? fmt::format("{:.0f} s", rounded) : fmt::format("{:.0f} min", std::ceil(seconds / 60.0));
}

std::string as_json(pipeline::Forecast const& forecast) {
    nlohmann::ordered_json json{{"stages", forecast.stages}, {"grid", nullptr}};
    if (forecast.grid) {
        Grid const& grid = *forecast.grid;
        json["grid"] = {{"width", grid.width}, {"height", grid.height}, {"cell", grid.cell_m},
                        {"west", grid.west},   {"north", grid.north},   {"crs", grid.crs}};
    }
    json["cells"] = forecast.cells;
    json["memory_bytes"] = forecast.memory_bytes;
    json["seconds"] = forecast.seconds;
    return json.dump(2) + "\n";
}

/// A forecast as text, or as one JSON object: stages, grid (null: unknown), cells, memory_bytes, seconds.
std::string forecast_in_words(pipeline::Forecast const& forecast, bool json) {
    if (json) {
        return as_json(forecast);
    }
    std::string text = fmt::format("stages     {}\n", fmt::join(forecast.stages, ", "));
    if (forecast.grid) {
        Grid const& grid = *forecast.grid;
        text +=
            fmt::format("grid       {} x {} cells of {} m, {}, from ({}, {})\n", grid.width, grid.height, grid.cell_m,
                        grid.crs.empty() || grid.crs.size() > 40 ? "own CRS" : grid.crs, grid.west, grid.north);
    } else {
        text += fmt::format("grid       follows from the grown rivers: about {:.1g} cells\n",
                            static_cast<double>(forecast.cells));
    }
    text += fmt::format("memory     at most {:.2g} GB\n", static_cast<double>(forecast.memory_bytes) / 1e9);
    text += fmt::format("time       about {} on one core\n", time_in_words(forecast.seconds));
    return text + "nothing was written\n";
}

struct MakeOptions {
    std::string input;
    std::string folder = "valley";
    std::vector<std::string> set;
    std::optional<std::uint64_t> seed;
    std::string crs;
    std::string source_crs;
    std::vector<std::string> fields;
    std::string units;
    std::string schema;
    bool overwrite = false;
    bool dry_run = false;
};

/// The recipe if no file is given: if keys of the cluster are set, a cluster; else rivers that suit the grid.
pipeline::Recipe recipe_without_file(MakeOptions const& options) {
    bool const of_cluster = std::ranges::any_of(options.set, [](std::string const& assignment) {
        return assignment.starts_with("network.dla.") || assignment.starts_with("network.source=dla") ||
               assignment.starts_with("network.source=\"dla");
    });
    if (of_cluster) {
        return pipeline::cluster_recipe();
    }
    pipeline::Recipe asked = pipeline::default_recipe();
    for (std::string const& assignment : options.set) {
        pipeline::set_key(asked, assignment);
    }
    return pipeline::default_recipe_on(asked.grid.width, asked.grid.height);
}

/// The columns of a line file that have a role in the network, named as for `thalweg check`.
pipeline::Recipe with_fields(pipeline::Recipe recipe, std::vector<std::string> const& fields) {
    static std::map<std::string, char const*> const keys{{"arc_id", "network.lines.id_field"},
                                                         {"ds_arc", "network.lines.down_field"},
                                                         {"key", "network.lines.rank_field"},
                                                         {"type", "network.lines.type_field"}};
    for (auto const& [quantity, name] : fields_by_quantity(fields)) {
        auto const key = keys.find(quantity);
        refuse_if<BadParameter>(key == keys.end(),
                                "--field {}={}: make reads arc_id, ds_arc, key (a rank that falls downstream) and type "
                                "from fields that are named",
                                quantity, name);
        pipeline::set_key(recipe, fmt::format("{}={}", key->second, name));
    }
    return recipe;
}

pipeline::Recipe recipe_of(MakeOptions const& options) {
    pipeline::Recipe recipe =
        options.input.empty() ? recipe_without_file(options) : pipeline::recipe_from(options.input);
    for (std::string const& assignment : options.set) {
        pipeline::set_key(recipe, assignment);
    }
    if (options.seed) {
        pipeline::set_key(recipe, fmt::format("seed={}", *options.seed));
    }
    if (!options.crs.empty()) {
        pipeline::set_key(recipe, "grid.crs=" + options.crs);
    }
    if (!options.source_crs.empty()) {
        pipeline::set_key(recipe, "network.lines.source_crs=" + options.source_crs);
    }
    recipe = with_fields(std::move(recipe), options.fields);
    if (!options.units.empty()) {
        pipeline::set_key(recipe, "output.units=" + options.units);
    }
    if (!options.schema.empty()) {
        pipeline::set_key(recipe, fmt::format("output.schema={}", options.schema));
    }
    return recipe;
}

void tell_all(char const* what, std::vector<Finding> const& findings, Run const& run) {
    for (Finding const& finding : findings) {
        run.tell(what, finding.text);
    }
}

int make(MakeOptions const& options, Session const& session) {
    auto const existing = options.overwrite ? io::Existing::replace : io::Existing::refuse;
    pipeline::Recipe recipe = recipe_of(options);
    pipeline::UserFiles const files(recipe, session.run);
    if (options.dry_run) {
        fmt::print("{}", forecast_in_words(pipeline::forecast(recipe, session.run), session.json));
        return Exit::done;
    }
    pipeline::check_folder(options.folder, existing);
    pipeline::Made const made = pipeline::make(recipe, session.run);
    pipeline::write_terrain(made, options.folder, existing, session.run);
    if (session.verbose) {
        tell_all("repair", pipeline::repairs_of(made), session.run);
        tell_all("finding", made.assessment.findings, session.run);
    }
    for (Check const& check : made.assessment.checks) {
        if (!check.ok) {
            session.run.tell("check", fmt::format("{}  {}", in_words(check), toned(Tone::bad, "FAILED", stderr)));
        }
    }
    if (made.assessment.passed()) {
        std::string words = fmt::format("{} checks", made.assessment.checks.size());
        if (made.recipe.network) {
            std::size_t const outlets = made.terrain.rivers.network.planform.outlets().size();
            words += fmt::format(", {} outlet{}", outlets, outlets == 1 ? "" : "s");
        }
        if (made.terrain.surface) {
            words += fmt::format(", {} cells in pits", made.assessment.pits);
        }
        session.run.tell("check", fmt::format("{:<56}      {}", words, toned(Tone::good, "ok", stderr)));
    }
    session.run.tell(
        "open", fmt::format("{}   (no internet needed)", toned(Tone::name, options.folder + "/report.html", stderr)));
    fmt::print("{}", session.json ? io::read_text(options.folder + "/report.json", 1 << 30) : options.folder + "\n");
    return made.assessment.passed() ? Exit::done : Exit::check_failed;
}

} // namespace

Command add_make(CLI::App& app, Session& session) {
    auto const options = std::make_shared<MakeOptions>();
    app.add_option(
           "INPUT", options->input,
           "A recipe (TOML), or rivers: any file of lines that GDAL reads, or a folder written by make or convert. "
           "Without it, thalweg grows a valley on 1024x1024 cells.")
        ->type_name("FILE(toml,gpkg,shp,geojson,json,fgb,kml,gpx,gdb,zip)");
    app.add_option("-o,--output", options->folder, "Write to this folder.")->type_name("DIR")->capture_default_str();
    app.add_option(
           "--set", options->set,
           "Set a key of the recipe; it overrides the file. May be repeated; the last value wins. File names are "
           "relative to the current folder.")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--seed", options->seed, "Set the random seed; the same as --set seed=N.")->check(is_seed);
    app.add_option("--crs", options->crs,
                   "Make the terrain in this projected CRS in metres; the same as --set grid.crs=CRS.")
        ->type_name("EPSG:N");
    app.add_option("--source-crs", options->source_crs,
                   "Read rivers whose file has no CRS in this one; the same as --set network.lines.source_crs=CRS.")
        ->type_name("EPSG:N");
    app.add_option(
           "--field", options->fields,
           "Name the field of rivers that holds a quantity: arc_id and ds_arc (a line's id and that of the line "
           "downstream), key (a rank that falls downstream) or type. May be repeated. The same as --set "
           "network.lines.id_field=NAME, down_field, rank_field and type_field.")
        ->type_name("QUANTITY=NAME")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--units", options->units,
                   "Write heights in metres or in international feet (dem.tif, networks, contours, TINs); the same as "
                   "--set output.units=UNIT. Lengths stay in m, areas in m2.")
        ->check(CLI::IsMember({"m", "ft"}));
    app.add_option(
           "--schema", options->schema,
           "Also write the network in this schema, as network_SCHEMA.gpkg; the same as --set output.schema=SCHEMA.")
        ->check(CLI::IsMember(schema_names()));
    app.add_flag("--dry-run", options->dry_run,
                 "Check the recipe and its input files, and print the stages, the grid, and estimates of memory and "
                 "time. Nothing is written.");
    app.add_flag("--json", session.json, "Print report.json to stdout instead of the name of the folder.");
    app.add_flag("--overwrite", options->overwrite,
                 "Replace the files that an earlier make wrote to the folder. Other files in the folder are kept.");
    app.footer(
        "Rivers are grown, or read from a file of lines; they get heights, and the terrain is shaped around "
        "them. The recipe holds everything that decides the result: the same recipe gives the same bytes on any "
        "machine. The folder is written completely or not at all.\n\n"
        "Rivers need no recipe: thalweg chooses the grid and its cell size from the data and makes equilibrium "
        "terrain around them. `thalweg recipe --for RIVERS` prints the recipe that it uses. From a folder written "
        "by make or convert it takes the arcs.\n\n"
        "Examples:\n"
        "  thalweg make\n"
        "  thalweg make samples/dla.toml --seed 8 --set network.prune=40 -o out/sparse\n"
        "  thalweg make out/sparse/recipe.toml -o out/again\n"
        "  thalweg make samples/walker_nhdplus.gpkg -o out/walker\n"
        "  thalweg make samples/walker_nhdplus.gpkg --crs EPSG:26910 --set grid.cell=30 -o out/utm\n"
        "  thalweg make out/walker --seed 8 -o out/other\n"
        "  thalweg make samples/walker_nhdplus.gpkg --dry-run\n");
    return [options, &session] { return make(*options, session); };
}

} // namespace thalweg::tools
