// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

#include <thalweg/pipeline/recipe.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

namespace thalweg::tools {

namespace {

int print_keys() {
    std::string section = " ";
    for (pipeline::KeyHelp const& key : pipeline::recipe_keys()) {
        auto const dot = key.path.rfind('.');
        std::string const its_section = dot == std::string::npos ? "" : key.path.substr(0, dot);
        if (its_section != section) {
            section = its_section;
            fmt::print("{}{}", section.empty() ? "" : "\n",
                       section.empty()      ? ""
                       : section == "patch" ? "[[patch]]\n"
                                            : "[" + section + "]\n");
        }
        fmt::print("{:<18}{}{}\n{:<18}{}; {}{}\n", key.path.substr(dot == std::string::npos ? 0 : dot + 1), key.meaning,
                   key.unit.empty() ? "" : " [" + key.unit + "]", "", key.type, key.range,
                   key.standard.empty() ? "" : "; default " + key.standard);
    }
    return Exit::done;
}

} // namespace

Command add_recipe(CLI::App& app, Session&) {
    auto const dump = std::make_shared<bool>(false);
    app.add_flag("--dump", *dump, "Print the default recipe as a TOML file.");
    app.footer("Each key with its unit, range and default. thalweg-recipe(5) is the same as a manual page.\n\n"
               "Examples:\n"
               "  thalweg recipe\n"
               "  thalweg recipe --dump > mine.toml\n");
    return [dump] {
        if (*dump) {
            fmt::print("{}", pipeline::write_recipe(pipeline::default_recipe()));
            return static_cast<int>(Exit::done);
        }
        return print_keys();
    };
}

} // namespace thalweg::tools
