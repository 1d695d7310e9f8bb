// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/commands/replay.hpp>
#include <thalweg/core/run/messages.hpp>

#include "commands/commands.hpp"
#include "terminal/terminal.hpp"

namespace thalweg::tools {

namespace {

int replay(commands::ReplayParams const& params, Session const& session) {
    commands::ReplayResult const found = commands::run_replay(params, session.run);
    for (std::string const& name : found.same) {
        fmt::print("{}     {}\n", toned(Tone::good, "same", stdout), printable(name));
    }
    for (std::string const& name : found.differ) {
        fmt::print("{}  {}\n", toned(Tone::bad, "DIFFERS", stdout), printable(name));
    }
    for (std::string const& name : found.missing) {
        fmt::print("{}  {}\n", toned(Tone::bad, "MISSING", stdout), printable(name));
    }
    return found.verified() ? Exit::done : Exit::check_failed;
}

} // namespace

Command add_replay(CLI::App& app, Session& session) {
    auto const params = std::make_shared<commands::ReplayParams>();
    auto const verify = std::make_shared<bool>(true);
    app.add_option("DIR", params->folder, "A folder written by make.")->type_name("DIR")->required();
    app.add_flag("--verify", *verify, "Compare the bytes. This is always done; the option makes scripts readable.");
    app.footer("Runs recipe.toml again in a temporary folder and compares each file. The exit status is 3 when a file "
               "differs or is missing. Nothing is changed.\n\n"
               "Examples:\n"
               "  thalweg replay valley --verify\n");
    return [params, verify, &session] { return replay(*params, session); };
}

} // namespace thalweg::tools
