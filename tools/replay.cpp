// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

#include <thalweg/pipeline/replay.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

namespace thalweg::tools {

namespace {

int replay(std::string const& folder, Session const& session) {
    pipeline::Replayed const found = pipeline::replay(folder, session.run);
    for (std::string const& name : found.same) {
        fmt::print("same     {}\n", name);
    }
    for (std::string const& name : found.differ) {
        fmt::print("DIFFERS  {}\n", name);
    }
    for (std::string const& name : found.missing) {
        fmt::print("MISSING  {}\n", name);
    }
    return found.verified() ? Exit::done : Exit::check_failed;
}

} // namespace

Command add_replay(CLI::App& app, Session& session) {
    auto const folder = std::make_shared<std::string>();
    auto const verify = std::make_shared<bool>(true);
    app.add_option("DIR", *folder, "what an earlier make left")->required();
    app.add_flag("--verify", *verify, "compare the bytes, as it always does");
    return [folder, verify, &session] { return replay(*folder, session); };
}

} // namespace thalweg::tools
