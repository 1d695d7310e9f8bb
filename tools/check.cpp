// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "terminal.hpp"

#include <thalweg/pipeline/check_files.hpp>
#include <thalweg/pipeline/report.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace thalweg::tools {

namespace {

void print_table(pipeline::CheckedFiles const& checked) {
    fmt::print("{} arcs, {} nodes\n", checked.arcs, checked.nodes);
    for (Check const& c : checked.checks) {
        fmt::print("{:<24}{:>8}  {}\n", c.name, c.value,
                   c.ok ? toned(Tone::good, "ok", stdout) : toned(Tone::bad, "FAILED", stdout));
    }
    constexpr std::size_t shown = 50;
    for (std::size_t i = 0; i < std::min(shown, checked.findings.size()); ++i) {
        fmt::print("{}\n", checked.findings[i].text);
    }
    if (checked.findings.size() > shown) {
        fmt::print("... and {} more: --json prints all\n", checked.findings.size() - shown);
    }
}

int check(pipeline::CheckJob const& job, Session const& session) {
    pipeline::CheckedFiles const checked = pipeline::check_files(job, session.run);
    if (session.json) {
        fmt::print("{}", pipeline::checks_json(checked.checks, checked.findings));
    } else {
        print_table(checked);
    }
    return checked.ok() ? Exit::done : Exit::check_failed;
}

} // namespace

Command add_check(CLI::App& app, Session& session) {
    auto const job = std::make_shared<pipeline::CheckJob>();
    app.add_option("NETWORK", job->network, "A network.gpkg, a NAME_arcs.shp, or a folder that holds one.")
        ->type_name("FILE(gpkg,shp)")
        ->required();
    app.add_flag("--json", session.json, "Print one JSON object.");
    app.footer("Every arc is looked at: whether it runs from node to node, falls, meets no other but at its ends, and "
               "whether its orders and its downstream arc are right. Exit status 3 tells that a check failed.\n\n"
               "Examples:\n"
               "  thalweg check valley\n"
               "  thalweg check valley/network_arcs.shp --json\n");
    return [job, &session] { return check(*job, session); };
}

} // namespace thalweg::tools
