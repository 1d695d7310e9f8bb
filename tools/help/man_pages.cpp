// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "help/man_pages.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/pipeline/recipe/recipe.hpp>
#include <thalweg/pipeline/report/report.hpp>

#include "help/roff.hpp"

namespace thalweg::tools {

namespace {

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

/// What make leaves.
Rows const made{
    {"dem.tif", "Heights: a cloud-optimised GeoTIFF of 32-bit floats with its CRS and no-data value."},
    {"network.gpkg", "The layers arcs (lines with heights, drawn downstream) and nodes, and the table run."},
    {"network_arcs.shp, network_nodes.shp", "The same as shapefiles."},
    {"network_SCHEMA.gpkg", "The arcs in another schema, if the recipe names one."},
    {"network.tif", "River cells."},
    {"contours.gpkg", "Contour lines."},
    {"catchments.gpkg", "Catchments of arcs and basins, as polygons."},
    {"area_d8.tif, area_dinf.tif", "Contributing areas by cell, if the recipe asks for them."},
    {"map.png, profile.svg, curve.svg", "A map, long profiles of the streams, the increment curve."},
    {"wireframe.svg, sections.svg", "A wireframe seen up the valley, and cross-sections."},
    {"report.html", "Terrain, rivers, diagrams and statistics on one page for any browser; it needs no internet."},
    {"report.json", "Statistics, timings, checks and repairs."},
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
    return fmt::format(".TH {} {} \"\" \"thalweg {}\" \"{}\"\n.nh\n.ad l\n", roff(capitals), number,
                       pipeline::version(), manual);
}

/// A sentence as NAME has it: "make a terrain".
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
    if (command.name == "make") {
        out += section("FILES") + roff("In the folder of --output:") + "\n" + rows(made);
    }
    out += section("ENVIRONMENT") + rows(environment);
    return out + examples(command) + see_also(name + "1", program);
}

std::string key_text(pipeline::KeyHelp const& key) {
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
    for (pipeline::KeyHelp const& key : pipeline::recipe_keys()) {
        auto const dot = key.path.rfind('.');
        std::string const name = dot == std::string::npos ? key.path : key.path.substr(dot + 1);
        std::string const its_section = dot == std::string::npos ? "" : key.path.substr(0, dot);
        if (its_section != at) {
            at = its_section;
            out += ".SS " + roff(at == "patch" ? "[[patch]]" : "[" + at + "]") + "\n";
        }
        out += tagged(fmt::format("\\fB{}\\fR{}", roff(name), key.unit.empty() ? "" : roff(" [" + key.unit + "]")),
                      key_text(key));
    }
    out += section("EXAMPLES") + paragraph("The recipe that thalweg make uses without one:") + ".PP\n" +
           verbatim(pipeline::write_recipe(pipeline::default_recipe()));
    return out + see_also("thalweg-recipe5", program);
}

} // namespace

std::vector<ManPage> man_pages(CommandHelp const& program) {
    std::vector<ManPage> pages{{"thalweg", '1', program_page(program)}};
    for (CommandHelp const& command : program.commands) {
        pages.push_back({"thalweg-" + command.name, '1', command_page(command, program)});
    }
    pages.push_back({"thalweg-recipe", '5', recipe_page(program)});
    return pages;
}

} // namespace thalweg::tools
