// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/commands/ensemble.hpp>
#include <thalweg/commands/make.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/report/report.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"
#include "ranks/ranks.hpp"
#include "terminal/terminal.hpp"

namespace thalweg::tools {

namespace {

std::string time_in_words(double seconds) {
    double const rounded = std::max(1.0, std::ceil(seconds));
    return rounded < 120.0 ? fmt::format("{:.0f} s", rounded) : fmt::format("{:.0f} min", std::ceil(seconds / 60.0));
}

std::string as_json(recipe::Forecast const& forecast) {
    nlohmann::ordered_json json{{"stages", forecast.stages}, {"grid", nullptr}};
    if (forecast.grid) {
        Grid const& grid = *forecast.grid;
        json["grid"] = {{"width", grid.width}, {"height", grid.height}, {"cell", grid.cell_m},
                        {"west", grid.west},   {"north", grid.north},   {"crs", grid.crs}};
    }
    json["cells"] = forecast.cells;
    json["memory_bytes"] = forecast.memory_bytes;
    json["seconds"] = forecast.seconds;
    json["findings"] = nlohmann::ordered_json::parse(report::findings_json(forecast.findings));
    return json.dump(2) + "\n";
}

/// A forecast as text, or as one JSON object: stages, grid (null: unknown), cells, memory_bytes, seconds.
std::string forecast_in_words(recipe::Forecast const& forecast, bool json) {
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
    double const gigabytes = static_cast<double>(forecast.memory_bytes) / 1e9;
    text += fmt::format("memory     about {:.2g} GB\n", gigabytes);
    text += fmt::format("time       about {} on one core\n", time_in_words(forecast.seconds));
    return text + "nothing was written\n";
}

/// Of make; rebuild has two more.
struct MakeOptions {
    commands::RebuildFromParams params;
    commands::EnsembleParams ensemble; ///< what an ensemble has beside params
    std::string seeds;                 ///< A-B
    std::string share;                 ///< K/N
    std::vector<std::string> fields;
    bool dry_run = false;
};

/// Two whole numbers with a sign between them.
std::optional<std::array<std::int64_t, 2>> two_numbers(std::string_view text, char between) {
    std::array<std::int64_t, 2> numbers{};
    std::size_t const at = text.find(between);
    if (at == std::string_view::npos) {
        return {};
    }
    auto const read = [](std::string_view word, std::int64_t& number) {
        auto const [end, fault] = std::from_chars(word.data(), word.data() + word.size(), number);
        return fault == std::errc() && end == word.data() + word.size() && number >= 0;
    };
    bool const both = read(text.substr(0, at), numbers[0]) && read(text.substr(at + 1), numbers[1]);
    return both ? std::optional(numbers) : std::nullopt;
}

/// Runs make --ensemble.
int make_ensemble(MakeOptions& options, Session& session) {
    commands::EnsembleParams params = options.ensemble;
    static_cast<commands::MakeParams&>(params) = static_cast<commands::MakeParams const&>(options.params);
    if (!options.seeds.empty()) {
        auto const seeds = two_numbers(options.seeds, '-');
        if (!seeds || (*seeds)[0] > (*seeds)[1]) {
            throw BadParameter("commands.run_ensemble",
                               fmt::format("--seeds {}: write A-B, two whole numbers, B not below A", options.seeds));
        }
        params.first_seed = static_cast<std::uint64_t>((*seeds)[0]);
        params.members = (*seeds)[1] - (*seeds)[0] + 1;
    }
    if (!options.share.empty()) {
        auto const share = two_numbers(options.share, '/');
        if (!share) {
            throw BadParameter("commands.run_ensemble",
                               fmt::format("--share {}: write K/N, K from 1 to N", options.share));
        }
        params.share = (*share)[0];
        params.shares = (*share)[1];
    }
    if (options.dry_run) {
        recipe::Forecast const expected = commands::forecast_ensemble(params, session.run);
        fmt::print("{}", forecast_in_words(expected, session.json));
        return Exit::done;
    }
    std::unique_ptr<ensemble::Ranks> const ranks = join_ranks();
    if (ranks && ranks->rank() > 0) { // the first one speaks for all
        session.quiet = true;
        session.run.log = {};
        session.run.progress = nullptr;
        session.run.found = [](Finding const&) {};
    }
    ensemble::EnsembleResult const made =
        ranks ? commands::run_ensemble_on(*ranks, params, session.run) : commands::run_ensemble(params, session.run);
    if (ranks && ranks->rank() > 0) {
        return Exit::done;
    }
    nlohmann::ordered_json json{{"folder", params.output},
                                {"members", made.members},
                                {"made_now", made.made_now},
                                {"found", made.found},
                                {"seconds", made.seconds},
                                {"table", nullptr},
                                {"share", {params.share, params.shares}}};
    if (!made.table.empty()) {
        json["table"] = made.table;
        json["ok"] = made.ok;
        json["check_failed"] = made.checks_failed;
        json["failed"] = made.failed;
        json["with_warnings"] = made.warned;
        session.run.tell("table", toned(Tone::name, made.table, stderr));
    }
    json["findings"] = nlohmann::ordered_json::parse(report::findings_json(made.findings));
    fmt::print("{}\n", session.json ? json.dump(2) : params.output);
    if (session.quiet && made.failed + made.checks_failed > 0) { // no exit code without a word
        write_to_stderr(fmt::format("error: of {} members {} could not be made and {} fail a check: see {}\n",
                                    made.members, made.failed, made.checks_failed, made.table));
    }
    return made.failed > 0 ? Exit::failed : made.checks_failed > 0 ? Exit::check_failed : Exit::done;
}

/// An option that stands for a key of the recipe. It comes after --set, which replaces what is set.
template <class T>
CLI::Option* add_key_option(CLI::App& app, char const* name, char const* key, std::vector<std::string>& set,
                            char const* meaning) {
    auto const put = [&set, key](T const& value) {
        if (std::string const word = fmt::format("{}", value); !word.empty()) {
            set.push_back(fmt::format("{}={}", key, word));
        }
    };
    return app.add_option_function<T>(name, put, meaning);
}

/// Runs make, or rebuild.
int make(MakeOptions& options, bool rebuilds, Session& session) {
    options.params.fields = fields_by_quantity(options.fields);
    if (options.ensemble.members > 0 || !options.seeds.empty()) {
        return make_ensemble(options, session);
    }
    if (int const ranks = launched_ranks(); ranks > 1) {
        throw BadInput(
            "commands.run_make",
            fmt::format("mpirun has started {} processes, and one terrain is made by one: give --ensemble N, or "
                        "start it without mpirun and give --threads",
                        ranks));
    }
    if (options.dry_run) {
        recipe::Forecast const expected = rebuilds ? commands::forecast_rebuild(options.params, session.run)
                                                   : commands::forecast_make(options.params, session.run);
        fmt::print("{}", forecast_in_words(expected, session.json));
        return Exit::done;
    }
    make::MakeResult const made =
        rebuilds ? commands::run_rebuild(options.params, session.run) : commands::run_make(options.params, session.run);
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
        if (made.terrain.has_surface()) {
            words += fmt::format(", {} cells in pits", made.assessment.pits);
        }
        session.run.tell("check", fmt::format("{:<56}      {}", words, toned(Tone::good, "ok", stderr)));
    }
    if (made.recipe.output.has(recipe::OutputFiles::page)) {
        session.run.tell("open", fmt::format("{}   (no internet needed)",
                                             toned(Tone::name, options.params.output + "/report.html", stderr)));
    }
    fmt::print("{}", session.json ? io::read_text(options.params.output + "/report.json", 1 << 30)
                                  : options.params.output + "\n");
    if (session.quiet && !made.assessment.passed()) {
        auto const failed = std::ranges::find(made.assessment.checks, false, &Check::ok);
        write_to_stderr(fmt::format("error: a check failed: {}\n", in_words(*failed)));
    }
    return made.assessment.passed() ? Exit::done : Exit::check_failed;
}

/// The options that make and rebuild have.
void add_options_of_make(CLI::App& app, MakeOptions& options, Session& session) {
    app.add_option("-o,--output", options.params.output, "Write to this folder.")
        ->type_name("DIR")
        ->capture_default_str();
    add_list(app, "--set", "KEY=VALUE", options.params.set,
             "Set a key of the recipe; it overrides the file. May be repeated; the last value wins. File names are "
             "relative to the current folder.",
             '\0');
    add_key_option<std::uint64_t>(app, "--seed", "seed", options.params.set,
                                  "Set the random seed; the same as --set seed=N.")
        ->check(is_seed);
    add_key_option<std::string>(app, "--crs", "grid.crs", options.params.set,
                                "Make the terrain in this projected CRS in metres; the same as --set grid.crs=CRS.")
        ->type_name("EPSG:N");
    add_key_option<std::string>(
        app, "--source-crs", "network.lines.source_crs", options.params.set,
        "Read rivers whose file has no CRS in this one; the same as --set network.lines.source_crs=CRS.")
        ->type_name("EPSG:N");
    add_list(app, "--field", "QUANTITY=NAME", options.fields,
             "Name the field of rivers that holds a quantity: arc_id and ds_arc (a line's id and that of the line "
             "downstream), from_node and to_node (where its water comes from and goes to), direction (whether it runs "
             "as it is drawn), key (a rank that falls downstream) or type. May be repeated. The same as --set "
             "network.lines.id_field=NAME, down_field, from_field, to_field, direction_field, rank_field and "
             "type_field.",
             '\0');
    add_key_option<std::string>(
        app, "--where", "network.lines.where", options.params.set,
        "Read only the rivers that meet this condition on their fields, such as \"STRAHLER >= 3\"; the same as --set "
        "network.lines.where=SQL.")
        ->type_name("SQL");
    add_key_option<std::string>(
        app, "--units", "output.units", options.params.set,
        "Write heights in metres or in international feet (dem.tif, networks, contours, TINs); the same as "
        "--set output.units=UNIT. Lengths stay in m, areas in m2.")
        ->check(CLI::IsMember({"m", "ft"}));
    add_key_option<std::string>(
        app, "--schema", "output.schema", options.params.set,
        "Also write the network in this schema, as network_SCHEMA.gpkg; the same as --set output.schema=SCHEMA.")
        ->check(CLI::IsMember(schema_names()));
    add_key_option<std::string>(
        app, "--only", "output.files", options.params.set,
        "Write only these files, with commas between them: dem, network, contours, catchments, "
        "areas, tin, pictures, page or qgis; the same as --set output.files=FILES. recipe.toml and "
        "report.json are always written. Of an ensemble, dem,network if not given; table alone: only table.csv.")
        ->type_name("FILES");
    app.add_flag("--dry-run", options.dry_run,
                 "Check the recipe and its input files, and print the stages, the grid, and estimates of memory and "
                 "time. Nothing is written.");
    app.add_flag("--json", session.json, "Print report.json to stdout instead of the name of the folder.");
    add_overwrite_option(
        app, options.params.existing,
        "Replace the files that an earlier run wrote to the folder. Other files in the folder are kept.");
}

/// The options of ensembles, which make has alone.
void add_options_of_ensembles(CLI::App& app, MakeOptions& options) {
    commands::EnsembleParams& params = options.ensemble;
    CLI::Option* const members =
        app.add_option("--ensemble", params.members,
                       "Make N terrains: member i = 0, 1, ... has the recipe's seed + i. The folder then holds "
                       "table.csv, a row a member, and a folder for each. The same command goes on after a stop.")
            ->type_name("N")
            ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}));
    CLI::Option* const seeds =
        app.add_option("--seeds", options.seeds, "Make an ensemble with the seeds A to B.")->type_name("A-B");
    members->excludes(seeds);
    auto const needs_members = [&](CLI::Option* option) {
        option->check([members, seeds](std::string const&) {
            return members->count() + seeds->count() > 0 ? std::string() : "it needs --ensemble N or --seeds A-B";
        });
    };
    add_list(app, "--vary", "KEY=A..B|LIST", params.vary,
             "Of an ensemble: give a key a random number between A and B in each member, or the values of a list in "
             "turn. May be repeated.",
             '\0');
    app.add_option("--shards", params.members_a_shard,
                   "Of an ensemble: pack N members into one tar file, in place of folders.")
        ->type_name("N")
        ->expected(0, 1)
        ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000}))
        ->default_str("1000");
    app.add_option("--share", options.share,
                   "Of an ensemble: make part K of N, beside other processes that make the others. The same command "
                   "without --share makes what is missing, and the table.")
        ->type_name("K/N");
    for (char const* const name : {"--vary", "--shards", "--share"}) {
        needs_members(app.get_option(name));
    }
}

} // namespace

Command add_make(CLI::App& app, Session& session) {
    auto const options = std::make_shared<MakeOptions>();
    app.add_option("INPUT", options->params.input,
                   "A recipe (TOML), or rivers: any file of lines that GDAL reads, or a folder written by make or "
                   "convert; or a "
                   "DEM. Without it, thalweg grows a valley on 1024x1024 cells.")
        ->type_name("FILE(toml,gpkg,shp,geojson,json,fgb,kml,gpx,gdb,zip,tif,tiff,asc)");
    app.add_option("--preset", options->params.preset,
                   "Make land of this kind: give the keys of a preset to what neither the recipe nor --set gives. "
                   "`thalweg recipe --preset NAME` prints it as a recipe.")
        ->check(CLI::IsMember(preset_names()));
    add_options_of_make(app, *options, session);
    add_options_of_ensembles(app, *options);
    app.footer(
        "Rivers are grown, or read from a file of lines; they get heights, and the terrain is shaped around "
        "them. The recipe holds everything that decides the result: the same recipe gives the same bytes on any "
        "machine. The folder is written completely or not at all.\n\n"
        "Rivers need no recipe: thalweg chooses the grid and its cell size from the data and makes equilibrium "
        "terrain around them. `thalweg recipe --for RIVERS` prints the recipe that it uses. From a folder written "
        "by make or convert it takes the arcs. A DEM is taken as the terrain, cell by cell (surface.method = "
        "raster).\n\n"
        "Examples:\n"
        "  thalweg make\n"
        "  thalweg make samples/dla.toml --seed 8 --set network.prune=40 -o out/sparse\n"
        "  thalweg make out/sparse/recipe.toml -o out/again\n"
        "  thalweg make samples/walker_nhdplus.gpkg -o out/walker\n"
        "  thalweg make samples/walker_nhdplus.gpkg --crs EPSG:26910 --set grid.cell=30 -o out/utm\n"
        "  thalweg make --preset hills -o out/hills\n"
        "  thalweg make out/walker --seed 8 -o out/other\n"
        "  thalweg make samples/walker_nhdplus.gpkg --only dem,network -o out/two\n"
        "  thalweg make samples/walker_nhdplus.gpkg --dry-run\n"
        "  thalweg make samples/jacksboro_utm16.tif --set surface.drain=carve -o out/drained\n"
        "  thalweg make --set grid.width=128 --set grid.height=128 --ensemble 20 --vary surface.mean_slope=10..35 "
        "-o out/twenty\n");
    return [options, &session] { return make(*options, false, session); };
}

Command add_rebuild(CLI::App& app, Session& session) {
    auto const options = std::make_shared<MakeOptions>();
    options->params.output = "rebuilt";
    app.add_option("RIVERS", options->params.input,
                   "Rivers with heights: any file of lines that GDAL reads, or a folder written by make or convert.")
        ->type_name("FILE(gpkg,shp,geojson,json,fgb,kml,gpx,gdb,zip)")
        ->required();
    app.add_option("--like", options->params.like,
                   "Take the mean slope and the texture of this DEM, which may be of another place. Without it they "
                   "follow from the rivers. The same as --set surface.like=DEM.")
        ->type_name("DEM");
    app.add_option("--against", options->params.against,
                   "Make the terrain on the cells of this DEM and compare the two, beside a cone, a TIN and a dilation "
                   "around the same rivers: against.png, report.html and report.json. Its heights decide nothing of "
                   "the terrain. The same as --set output.against=DEM, but for the grid.")
        ->type_name("DEM");
    add_options_of_make(app, *options, session);
    app.footer(
        "Rivers keep their heights (network.heights = \"file\"); the terrain between them follows from where they "
        "run and how steep they are. docs/rebuild.md says how close it comes, and where it does not.\n\n"
        "Examples:\n"
        "  thalweg rebuild out/walker -o out/rebuilt\n"
        "  thalweg rebuild out/walker --against out/walker/dem.tif -o out/compared\n"
        "  thalweg rebuild out/walker --like samples/jacksboro_utm16.tif -o out/like\n");
    return [options, &session] { return make(*options, true, session); };
}

} // namespace thalweg::tools
