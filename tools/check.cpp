// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

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
            fmt::print("{:<24}{:>8}  {}\n", c.name, c.value, c.ok ? "ok" : "FAILED");
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
    app.add_option("NETWORK", *path, "network.gpkg, NAME_arcs.shp, or a folder that holds one")->required();
    app.add_flag("--json", session.json, "one JSON object on stdout");
    return [path, &session] { return check(*path, session); };
}

} // namespace thalweg::tools
