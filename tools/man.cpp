// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "man_pages.hpp"

#include <thalweg/core/error.hpp>
#include <thalweg/core/suggest.hpp>
#include <thalweg/io/files.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

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

void print_page(std::vector<ManPage> const& pages, std::string const& wanted) {
    std::vector<std::string> names;
    for (ManPage const& page : pages) {
        names.push_back(fmt::format("{}.{}", page.name, page.section));
        if (wanted == names.back() ||
            (page.section == '1' && (wanted == page.name || "thalweg-" + wanted == page.name))) {
            fmt::print("{}", page.roff);
            return;
        }
    }
    throw BadInput(fmt::format("man: there is no page '{}'.{} Its pages are {}.", wanted, did_you_mean(wanted, names),
                               fmt::join(names, ", ")));
}

} // namespace

Command add_man(CLI::App& app) {
    auto const page = std::make_shared<std::string>("thalweg");
    auto const folder = std::make_shared<std::string>();
    app.add_option("PAGE", *page, "The page to print: a command's name, or thalweg-recipe.5.")->capture_default_str();
    app.add_option("-o,--output", *folder, "Write every page below this folder, as man1/*.1 and man5/*.5, instead.")
        ->type_name("DIR");
    app.footer("The pages are in man(7), and follow from what --help knows.\n\n"
               "Examples:\n"
               "  thalweg man make | man -l -\n"
               "  thalweg man thalweg-recipe.5 | man -l -\n");
    return [page, folder, &app] {
        std::vector<ManPage> const pages = man_pages(describe(*app.get_parent()));
        if (folder->empty()) {
            print_page(pages, *page);
        } else {
            write_pages(pages, *folder);
        }
        return static_cast<int>(Exit::done);
    };
}

} // namespace thalweg::tools
