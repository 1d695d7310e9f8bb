// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/io/files/files.hpp>

#include "commands/commands.hpp"
#include "help/man_pages.hpp"

namespace thalweg::tools {

namespace {

/// As man(1) lays them out: FOLDER/man1/thalweg-make.1.
void write_pages(std::vector<ManPage> const& pages, std::string const& folder) {
    for (ManPage const& page : pages) {
        std::string const of_section = fmt::format("{}/man{}", folder, page.section);
        std::filesystem::create_directories(of_section);
        io::write_text(fmt::format("{}/{}.{}", of_section, page.name, page.section), page.roff);
    }
}

/// "thalweg", a command's name, or with its section, "recipe.5".
bool is_called(ManPage const& page, std::string const& name) {
    return page.section == '1' ? name == page.name || "thalweg-" + name == page.name
                               : fmt::format("thalweg-{}", name) == fmt::format("{}.{}", page.name, page.section);
}

} // namespace

Command add_man(CLI::App& app) {
    auto const name = std::make_shared<std::string>("thalweg");
    auto const folder = std::make_shared<std::string>();
    std::vector<std::string> names{"thalweg"};
    for (CLI::App const* command : app.get_parent()->get_subcommands(nullptr)) {
        names.push_back(command->get_name());
    }
    names.emplace_back("recipe.5");
    app.add_option("PAGE", *name, "The page to print: a command or recipe.5.")
        ->check(CLI::IsMember(names))
        ->capture_default_str();
    app.add_option("-o,--output", *folder, "Write all pages to this folder, as man1/*.1 and man5/*.5.")
        ->type_name("DIR");
    app.footer("The pages are in man(7) format and say the same as --help.\n\n"
               "Examples:\n"
               "  thalweg man make | man -l -\n"
               "  thalweg man recipe.5 | man -l -\n");
    return [name, folder, &app] {
        std::vector<ManPage> const pages = man_pages(describe(*app.get_parent()));
        if (folder->empty()) {
            auto const page =
                std::find_if(pages.begin(), pages.end(), [&](ManPage const& p) { return is_called(p, *name); });
            fmt::print("{}", page->roff);
        } else {
            write_pages(pages, *folder);
        }
        return static_cast<int>(Exit::done);
    };
}

} // namespace thalweg::tools
