// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/io/files/files.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/report/report.hpp>

#include "commands/commands.hpp"
#include "help/help.hpp"

namespace thalweg::tools {

namespace {

/// A page of the manual in man(7), plain ASCII, without a date.
struct ManPage {
    std::string name; ///< thalweg-make
    char section;     ///< '1': a command, '5': a file format
    std::string roff;
};

/// Escapes text for man(7): hyphens can be copied into a shell, no line is read as a request.
std::string roff(std::string const& text) {
    std::string out;
    bool line_begins = true;
    for (char const c : text) {
        if (line_begins && (c == '.' || c == '\'')) {
            out += "\\&";
        }
        line_begins = c == '\n';
        switch (c) {
        case '\\': out += "\\e"; break;
        case '-': out += "\\-"; break;
        case '\'': out += "\\(aq"; break;
        case '"': out += "\\(dq"; break;
        case '`': out += "\\(ga"; break;
        case '^': out += "\\(ha"; break;
        case '~': out += "\\(ti"; break;
        default: out += c;
        }
    }
    return out;
}

/// A line of a font macro: `.B text`.
std::string bold_line(std::string const& text) {
    return ".B " + roff(text) + "\n";
}

/// Lines in verbatim form.
std::string verbatim(std::string const& lines) {
    return ".RS 4\n.nf\n" + roff(lines) + ".fi\n.RE\n";
}

/// A tag and its indented description. tag: roff.
std::string tagged(std::string const& tag, std::string const& text) {
    return ".TP\n" + tag + "\n" + roff(wrapped(text, 76, 0)) + "\n";
}

/// Filled text.
std::string paragraph(std::string const& text) {
    return roff(wrapped(text, 76, 0)) + "\n";
}

std::string section(std::string const& name) {
    return ".SH " + name + "\n";
}

using Rows = std::vector<std::pair<char const*, char const*>>;

Rows const exit_codes{
    {"0", "Done."},
    {"1", "Failed while running: disk full, out of memory, a file that could not be written."},
    {"2", "The command line, the recipe or an input is wrong. Nothing was written."},
    {"3", "A check failed, or a file differs from what its recipe makes. The output files are kept."},
    {"130",
     "Interrupted by Ctrl-C (143: by SIGTERM, 129: by SIGHUP). Nothing was written. A second signal stops at once."},
};

Rows const environment{
    {"NO_COLOR", "If set, output has no colours. Only terminals get colours."},
    {"TERM", "If dumb or unset, there are no colours and no progress bar."},
    {"THALWEG_OPENCL_DEVICE", "The device of --device opencl as platform:device, such as 0:0. Default: a GPU, else an "
                              "accelerator, else the CPU."},
};

/// Files written by make.
Rows const made{
    {"dem.tif", "Heights: a cloud-optimised GeoTIFF of 32-bit floats with its CRS and no-data value."},
    {"network.gpkg", "The layers arcs (lines with heights, drawn downstream) and nodes, and the table run."},
    {"network_arcs.shp, network_nodes.shp", "The same as shapefiles."},
    {"network_SCHEMA.gpkg", "The arcs in another schema, if the recipe names one."},
    {"network.tif", "River cells."},
    {"contours.gpkg", "Contour lines."},
    {"catchments.gpkg", "Catchments of arcs and basins, as polygons."},
    {"area_d8.tif, area_dinf.tif", "Contributing areas by cell, if the recipe asks for them."},
    {"map.png, profile.svg, curve.svg", "A map, the long profile of the main stem, the increment curve."},
    {"wireframe.svg, sections.svg", "A wireframe seen up the valley, and cross-sections."},
    {"report.html", "Terrain, rivers, diagrams and statistics on one page for any browser; it needs no internet."},
    {"report.json", "Statistics, timings, checks and repairs."},
    {"project.qgz, dem.qml", "A QGIS project of these layers with their styles, and the style of the DEM."},
    {"recipe.toml, inputs/", "The recipe with every default written out, and copies of the files it names."},
};

std::string rows(Rows const& table) {
    std::string out;
    for (auto const& [name, meaning] : table) {
        out += tagged(".B " + roff(name), meaning);
    }
    return out;
}

std::string heading(std::string const& name, char number, std::string const& manual) {
    std::string capitals = name;
    std::transform(capitals.begin(), capitals.end(), capitals.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return fmt::format(".TH {} {} \"\" \"thalweg {}\" \"{}\"\n.nh\n.ad l\n", roff(capitals), number, report::version(),
                       manual);
}

/// A sentence as in NAME: "make a terrain".
std::string clause(std::string text) {
    if (text.size() > 1 && std::islower(static_cast<unsigned char>(text[1])) != 0) {
        text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
    }
    if (!text.empty() && text.back() == '.') {
        text.pop_back();
    }
    return text;
}

std::string paragraphs(std::string const& text) {
    std::string out;
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t const end = std::min(text.find("\n\n", begin), text.size());
        out += ".PP\n" + paragraph(text.substr(begin, end - begin));
        begin = end + 2;
    }
    return out;
}

std::string tag(OptionHelp const& option) {
    std::string out;
    for (std::string const& name : option.names) {
        out += fmt::format("{}\\fB{}\\fR", out.empty() ? "" : ", ", roff(name));
    }
    return out + (option.placeholder.empty() ? "" : fmt::format(" \\fI{}\\fR", roff(option.placeholder)));
}

std::string meaning(OptionHelp const& option) {
    std::string out = option.meaning;
    if (option.takes == Takes::word) {
        out += fmt::format(" One of {}.", fmt::join(option.words, ", "));
    }
    return option.standard.empty() ? out : fmt::format("{} Default: {}.", out, option.standard);
}

std::string options(CommandHelp const& command) {
    std::string out = section("OPTIONS");
    for (OptionHelp const& p : command.positionals) {
        out += tagged(".I " + roff(long_name(p)), meaning(p));
    }
    for (OptionHelp const& option : command.options) {
        out += tagged(tag(option), meaning(option));
    }
    return out;
}

std::string examples(CommandHelp const& command) {
    std::string lines;
    for (std::string const& example : command.examples) {
        lines += example.substr(std::min(example.find_first_not_of(' '), example.size())) + "\n";
    }
    return lines.empty() ? "" : section("EXAMPLES") + verbatim(lines);
}

std::string see_also(std::string const& self, CommandHelp const& program) {
    std::vector<std::string> pages;
    auto const add = [&](std::string const& name, char number) {
        if (name + number != self) {
            pages.push_back(fmt::format("\\fB{}\\fR({})", roff(name), number));
        }
    };
    add("thalweg", '1');
    for (CommandHelp const& command : program.commands) {
        add("thalweg-" + command.name, '1');
    }
    add("thalweg-recipe", '5');
    return section("SEE ALSO") + fmt::format("{}\n", fmt::join(pages, ",\n"));
}

std::string program_page(CommandHelp const& program) {
    std::string out = heading("thalweg", '1', "User Commands");
    out += section("NAME") + "thalweg \\- terrain from its rivers outward\n";
    out += section("SYNOPSIS") + ".B thalweg\n.I COMMAND\n.RI [ OPTIONS ]\n";
    out += section("DESCRIPTION") +
           paragraph("thalweg starts with the rivers. It grows a river network or reads one from a line file, orders "
                     "it, assigns heights and shapes the terrain around it. It writes a topology-checked network, a "
                     "DEM that these rivers drain, contours and pictures.");
    out += section("COMMANDS");
    for (CommandHelp const& command : program.commands) {
        out += tagged(fmt::format(".BR {} (1)", roff("thalweg-" + command.name)), command.summary);
    }
    out += options(program);
    out += section("EXIT STATUS") + rows(exit_codes);
    out += section("FILES") + roff("Files that make writes to its folder:") + "\n" + rows(made);
    out += section("ENVIRONMENT") + rows(environment);
    return out + examples(program) + see_also("thalweg1", program);
}

std::string command_page(CommandHelp const& command, CommandHelp const& program) {
    std::string const name = "thalweg-" + command.name;
    std::string out = heading(name, '1', "User Commands");
    out += section("NAME") + roff(name) + " \\- " + roff(clause(command.summary)) + "\n";
    out += section("SYNOPSIS") + bold_line("thalweg " + command.name) + ".RI [ OPTIONS ]\n";
    for (OptionHelp const& p : command.positionals) {
        std::string const word = roff(long_name(p)) + (p.repeats ? "..." : "");
        out += p.required ? ".I " + word + "\n" : ".RI [ " + word + " ]\n";
    }
    out += section("DESCRIPTION") + paragraph(command.summary) + paragraphs(command.text);
    out += options(command);
    out += section("EXIT STATUS") + rows(exit_codes);
    if (command.name == "make" || command.name == "rebuild") {
        out += section("FILES") + roff("In the folder of --output:") + "\n" + rows(made);
    }
    out += section("ENVIRONMENT") + rows(environment);
    return out + examples(command) + see_also(name + "1", program);
}

std::string key_text(recipe::KeyHelp const& key) {
    std::string const out = fmt::format("{}.\n{}: {}.", key.meaning, key.type, key.range);
    std::string const standard = key.standard.empty() ? "" : fmt::format("\nDefault: {}.", key.standard);
    std::string const used_by = key.used_by.empty() ? "" : fmt::format("\nUsed with {}.", key.used_by);
    return out + standard + used_by;
}

std::string recipe_page(CommandHelp const& program) {
    std::string out = heading("thalweg-recipe", '5', "File Formats");
    out += section("NAME") + roff("thalweg-recipe") + " \\- everything that decides a terrain, in one file\n";
    out +=
        section("DESCRIPTION") +
        paragraph("A recipe is a TOML file. A key that is left out has its default; an unknown key is an error. The "
                  "option --set section.key=value of thalweg make overrides the file. File names are relative to "
                  "the recipe's folder. Without a [network] section there are no rivers; without a [surface] "
                  "section only the network is made.") +
        paragraph(
            "Many keys have an effect only with certain values of others: \"Used with\" names them. A key that is set "
            "and has no effect is an error, unless its value is its default or that of an earlier version. The "
            "recipe.toml that make writes holds every key that was used, with its value, and no other.");
    out += section("KEYS");
    std::string at;
    for (recipe::KeyHelp const& key : recipe::recipe_keys()) {
        auto const dot = key.path.rfind('.');
        std::string const name = dot == std::string::npos ? key.path : key.path.substr(dot + 1);
        std::string const its_section = dot == std::string::npos ? "" : key.path.substr(0, dot);
        if (its_section != at) {
            at = its_section;
            out += ".SS " + roff(recipe::is_array_section(at) ? "[[" + at + "]]" : "[" + at + "]") + "\n";
        }
        out += tagged(fmt::format("\\fB{}\\fR{}", roff(name), key.unit.empty() ? "" : roff(" [" + key.unit + "]")),
                      key_text(key));
    }
    out += section("EXAMPLES") + paragraph("The recipe that thalweg make uses without one:") + ".PP\n" +
           verbatim(recipe::write_recipe(recipe::default_recipe()));
    return out + see_also("thalweg-recipe5", program);
}

/// thalweg(1), one page per command, and thalweg-recipe(5), generated from the parser's description and the recipe's
/// keys.
std::vector<ManPage> man_pages(CommandHelp const& program) {
    std::vector<ManPage> pages{{"thalweg", '1', program_page(program)}};
    for (CommandHelp const& command : program.commands) {
        pages.push_back({"thalweg-" + command.name, '1', command_page(command, program)});
    }
    pages.push_back({"thalweg-recipe", '5', recipe_page(program)});
    return pages;
}

/// Writes pages in the layout of man(1): FOLDER/man1/thalweg-make.1.
void write_pages(std::vector<ManPage> const& pages, std::string const& folder) {
    for (ManPage const& page : pages) {
        std::string const of_section = fmt::format("{}/man{}", folder, page.section);
        std::filesystem::create_directories(of_section);
        io::write_text(fmt::format("{}/{}.{}", of_section, page.name, page.section), page.roff);
    }
}

/// Matches "thalweg", a command's name, or a name with its section, "recipe.5".
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
