// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "terminal.hpp"

#include <thalweg/io/read_network.hpp>
#include <thalweg/measure/topology.hpp>
#include <thalweg/pipeline/report.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

namespace thalweg::tools {

namespace {

int check(std::string const& path, Session const& session) {
    NetworkFile const network = io::read_network(path, session.run);
    measure::TopologyReport const report = measure::check_topology(network, session.run);
    bool const ok = std::all_of(report.checks.begin(), report.checks.end(), [](Check const& c) { return c.ok; });
    if (session.json) {
        fmt::print("{}", pipeline::checks_json(report.checks, report.findings));
    } else {
        fmt::print("{} arcs, {} nodes\n", network.arcs.size(), network.nodes.size());
        for (Check const& c : report.checks) {
            fmt::print("{:<24}{:>8}  {}\n", c.name, c.value,
                       c.ok ? toned(Tone::good, "ok", stdout) : toned(Tone::bad, "FAILED", stdout));
        }
        constexpr std::size_t shown = 50;
        for (std::size_t i = 0; i < std::min(shown, report.findings.size()); ++i) {
            fmt::print("{}\n", report.findings[i].text);
        }
        if (report.findings.size() > shown) {
            fmt::print("... and {} more: --json prints all\n", report.findings.size() - shown);
        }
    }
    return ok ? Exit::done : Exit::check_failed;
}

} // namespace

Command add_check(CLI::App& app, Session& session) {
    auto const path = std::make_shared<std::string>();
    app.add_option("NETWORK", *path, "A network.gpkg, a NAME_arcs.shp, or a folder that holds one.")
        ->type_name("FILE(gpkg,shp)")
        ->required();
    app.add_flag("--json", session.json, "Print one JSON object.");
    app.footer("Every arc is looked at: whether it runs from node to node, falls, meets no other but at its ends, and "
               "whether its orders and its downstream arc are right. Exit status 3 tells that a check failed.\n\n"
               "Examples:\n"
               "  thalweg check valley\n"
               "  thalweg check valley/network_arcs.shp --json\n");
    return [path, &session] { return check(*path, session); };
}

} // namespace thalweg::tools
