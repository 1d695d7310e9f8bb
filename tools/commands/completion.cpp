// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands/commands.hpp"
#include "help/complete.hpp"

namespace thalweg::tools {

Command add_completion(CLI::App& app) {
    auto const shell = std::make_shared<std::string>();
    app.add_option("SHELL", *shell, "The shell.")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
    app.footer("The script completes commands, options and their values, files and recipe keys. An installed thalweg "
               "includes it; from a build, source it.\n\n"
               "Examples:\n"
               "  source <(thalweg completion bash)\n"
               "  thalweg completion fish > ~/.config/fish/completions/thalweg.fish\n");
    return [shell, &app] {
        CommandHelp const program = describe(*app.get_parent());
        fmt::print("{}", *shell == "bash"  ? bash_completion(program)
                         : *shell == "zsh" ? zsh_completion(program)
                                           : fish_completion(program));
        return static_cast<int>(Exit::done);
    };
}

} // namespace thalweg::tools
