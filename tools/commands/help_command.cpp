// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands/commands.hpp"
#include "help/help.hpp"

namespace thalweg::tools {

Command add_help(CLI::App& app) {
    auto const name = std::make_shared<std::string>();
    std::vector<std::string> names;
    for (CLI::App const* command : app.get_parent()->get_subcommands(nullptr)) {
        names.push_back(command->get_name());
    }
    app.add_option("COMMAND", *name, "The command to explain. Default: thalweg itself.")->check(CLI::IsMember(names));
    return [name, &app] {
        CLI::App* const program = app.get_parent();
        fmt::print("{}", help_text(name->empty() ? *program : *program->get_subcommand(*name)));
        return static_cast<int>(Exit::done);
    };
}

} // namespace thalweg::tools
