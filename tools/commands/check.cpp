// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/commands/check.hpp>
#include <thalweg/core/run/messages.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"
#include "terminal/terminal.hpp"

namespace thalweg::tools {

namespace {

struct CheckOptions {
    commands::CheckParams params;
    std::vector<std::string> fields;
};

void print_some(std::vector<Finding> const& findings, char const* before, Session const& session) {
    std::size_t const shown = session.verbose ? findings.size() : 50;
    for (std::size_t i = 0; i < std::min(shown, findings.size()); ++i) {
        fmt::print("{}{}\n", before, printable(findings[i].text));
    }
    if (findings.size() > shown) {
        fmt::print("{}... and {} more; --verbose prints all\n", before, findings.size() - shown);
    }
}

void print_certificate(measure::Certificate const& c) {
    fmt::print("{} river cells, {} with the flow direction of their river; {} of {} sources reach their outlet\n",
               c.river_cells, c.following_cells, c.arriving_sources, c.sources);
    auto const print_agreement = [](char const* what, measure::Agreements const& agreements) {
        for (std::size_t k = 0; k < agreements.size(); ++k) {
            fmt::print("{} within {} cells: precision {:.4f}  recall {:.4f}  F {:.4f}\n", what, k,
                       agreements[k].precision, agreements[k].recall, agreements[k].f());
        }
    };
    print_agreement("traced", c.traced);
    print_agreement(fmt::format("extracted from {} cells,", c.threshold_cells).c_str(), c.extracted);
    if (c.compared_areas > 0) {
        fmt::print("{} of {} contributing areas within 5 % of the DEM's\n", c.close_areas, c.compared_areas);
    }
}

void print_table(commands::CheckResult const& checked, std::string const& network, Session const& session) {
    fmt::print("{} arcs, {} nodes\n", checked.arcs, checked.nodes);
    for (Check const& c : checked.checks) {
        fmt::print("{:<24}{:>8.6g}  {}\n", c.name, c.value,
                   c.ok ? toned(Tone::good, "ok", stdout)
                        : toned(Tone::bad, "FAILED", stdout) + fmt::format(" ({})", limit_in_words(c)));
    }
    if (checked.certificate) {
        print_certificate(*checked.certificate);
    }
    if (!checked.ok()) {
        print_some(checked.findings, "", session);
    } else if (!checked.findings.empty()) {
        fmt::print("{} findings that fail no check; --findings FILE or --json lists them\n", checked.findings.size());
    }
    print_some(checked.notes, "note: ", session);
    print_some(checked.mended, "mended: ", session);
    for (std::string const& file : checked.written) {
        fmt::print("{}\n", file);
    }
    fmt::print("{}\n",
               toned(checked.ok() ? Tone::good : Tone::bad, printable(verdict(network, checked.checks)), stdout));
}

int check(CheckOptions& options, Session const& session) {
    options.params.read.fields = fields_by_quantity(options.fields);
    commands::CheckResult const checked = commands::run_check(options.params, session.run);
    if (session.json) {
        fmt::print("{}", commands::as_json(checked));
    } else {
        print_table(checked, options.params.network, session);
    }
    return checked.ok() ? Exit::done : Exit::check_failed;
}

} // namespace

Command add_check(CLI::App& app, Session& session) {
    auto const options = std::make_shared<CheckOptions>();
    add_network_options(app, options->params.network, options->params.read, options->fields, "--schema,--from");
    app.add_option("--dem", options->params.dem,
                   "Also check that this DEM drains, and by these rivers; --fix finds the flow direction of lines by "
                   "it. It must have the network's CRS or, of a network in degrees, be in its UTM zone: the network is "
                   "then reprojected.")
        ->type_name("FILE(tif)");
    app.add_option(
           "--fix", options->params.fix,
           "Write a repaired copy in the native schema and list the repairs. Nothing is written if faults remain. "
           "NETWORK may then be any file of lines.")
        ->type_name("FILE(gpkg,shp)");
    app.add_option("--findings", options->params.findings, "Write the findings as a point layer, for QGIS.")
        ->type_name("FILE(gpkg)");
    app.add_option(
           "--near", options->params.near_m,
           "Report line ends closer than this to a line that they do not meet [m]; --fix joins those that meet no "
           "other line. Default: a millionth of the network's extent; --fix: by the cell that make would take.")
        ->type_name("M")
        ->check(CLI::NonNegativeNumber);
    add_main_option(app, options->params.main);
    app.get_option("--main")->needs(app.get_option("--fix"));
    add_dem_options(app, options->params.reading);
    add_json_option(app, session);
    add_overwrite_option(app, options->params.existing, "Replace existing --fix and --findings files.");
    app.footer("Every arc is checked: it runs from node to node and downhill, meets other arcs at its ends only, and "
               "has the right orders and downstream arc. A file in another schema is checked for what it contains. A "
               "fault is reported once, without its consequences. The exit status is 3 when a check fails, also when a "
               "repaired copy was written. NETWORK itself is never changed.\n\n"
               "With --dem, these also fail: depressions, rivers along the border of the DEM, sources whose water does "
               "not reach their outlet, flow paths of which less than 99 % lie within a cell of the rivers, and rivers "
               "of which flow paths cover less than 95 %. Agreement by contributing area is reported only: a DEM may "
               "have more valleys than rivers.\n\n"
               "Examples:\n"
               "  thalweg check valley\n"
               "  thalweg check valley --dem valley/dem.tif\n"
               "  thalweg check valley/network_arcs.shp --json\n"
               "  thalweg check rivers.gpkg --fix mended.gpkg --findings check.gpkg\n"
               "  thalweg check net.shp --schema taudem\n"
               "  thalweg check rivers.fgb --field arc_id=ID --field ds_arc=NEXT\n");
    return [options, &session] { return check(*options, session); };
}

} // namespace thalweg::tools
