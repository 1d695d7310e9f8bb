// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/commands/grow.hpp>
#include <thalweg/core/run/refuse.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

struct GrowOptions {
    commands::GrowParams params;
    std::string rule = "tokunaga";
    bool shapes_tree = false; ///< --generator, --order or --rule is given
};

constexpr std::array<char const*, 3> side_rules{"tokunaga", "constant", "plane"}; // as growth::SideRule

nlohmann::ordered_json json_of(GrowOptions const& options, commands::GrowResult const& c) {
    return {{"generator", options.params.tree.generator},
            {"order", c.streams.order},
            {"rule", options.rule},
            {"seed", options.params.tree.seed},
            {"links", c.streams.links},
            {"sources", c.streams.sources},
            {"streams", c.streams.streams},
            {"side_branches", c.streams.side},
            {"side_branches_law", c.side_law},
            {"bifurcation", c.bifurcation},
            {"bifurcation_law", c.laws.bifurcation}};
}

void print_table(commands::GrowResult const& c) {
    fmt::print("links    {}, of which {} are sources\n", c.streams.links, c.streams.sources);
    fmt::print("order    {}\n", c.streams.order);
    fmt::print("\norder w      streams N_w  N_w / N_w+1 (law {:.3f})\n", c.laws.bifurcation);
    for (std::size_t w = 0; w < c.streams.streams.size(); ++w) {
        fmt::print("{:7}  {:15}{}\n", w + 1, c.streams.streams[w],
                   w < c.bifurcation.size() ? fmt::format("  {:11.3f}", c.bifurcation[w]) : "");
    }
    if (c.streams.side.empty()) {
        return;
    }
    fmt::print("\norders lower k   side branches T_k    law {:.3g} * {:.3f}^(k-1)\n", c.laws.a, c.laws.c);
    for (std::size_t k = 0; k < c.streams.side.size(); ++k) {
        fmt::print("{:13}  {:19.3f}  {:23.3f}\n", k + 1, c.streams.side[k], c.side_law[k]);
    }
}

/// What the options ask to be printed must be one thing.
void check_output(GrowOptions const& options, Session const& session) {
    commands::GrowParams const& params = options.params;
    if (!params.rules.empty()) {
        refuse_if<BadParameter>(options.shapes_tree, "commands.run_grow",
                                "--generator, --order and --rule are those of Tokunaga networks: --rules has its own");
        refuse_if<BadParameter>(params.output.empty() == !params.word, "commands.run_grow",
                                "--rules needs --lsystem, to print the word, or -o FILE, to draw it");
    } else {
        refuse_if<BadParameter>(params.output.empty() && params.word && session.json, "commands.run_grow",
                                "thalweg grow prints a word or JSON: give --lsystem or --json, not both");
    }
}

int grow(GrowOptions& options, Session const& session) {
    check_output(options, session);
    commands::GrowParams& params = options.params;
    params.tree.rule = static_cast<growth::SideRule>(std::ranges::find(side_rules, options.rule) - side_rules.begin());
    commands::GrowResult const grown = commands::run_grow(params, session.run);
    if (!params.output.empty()) {
        print_result(session, {{"file", params.output}, {"signs", grown.word.size()}, {"lines", grown.lines}},
                     {params.output}, -1);
    } else if (params.word) {
        fmt::print("{}\n", grown.word);
    } else if (session.json) {
        print_result(session, json_of(options, grown), {}, -1);
    } else {
        print_table(grown);
    }
    return Exit::done;
}

} // namespace

Command add_grow(CLI::App& app, Session& session) {
    auto const options = std::make_shared<GrowOptions>();
    commands::GrowParams& params = options->params;
    app.add_flag("--lsystem", params.word, "Print the network as an L-system word on one line.");
    app.add_option("--rules", params.rules,
                   "Rewrite the L-system of this text file instead: lines axiom WORD, iterations N, angle DEGREES and "
                   "SIGN -> WORD.")
        ->type_name("FILE");
    app.add_option("-o,--output", params.output, "Draw the word of --rules as this picture: .svg, .png or .pdf.")
        ->type_name("FILE");
    add_overwrite_option(app, params.existing, "Replace an existing picture.");
    CLI::Option const* const generator =
        app.add_option(
               "--generator", params.tree.generator,
               "Use this generator (lambda), 1 to 50: 1 has no side branches, high numbers give a feathered network.")
            ->type_name("N")
            ->capture_default_str();
    CLI::Option const* const order =
        app.add_option("--order", params.tree.order, "Set the Strahler order of the outlet, 1 to 30.")
            ->type_name("N")
            ->capture_default_str();
    CLI::Option const* const rule =
        app.add_option("--rule", options->rule, "Choose how many side branches a link gets in each refinement.")
            ->check(CLI::IsMember(side_rules))
            ->capture_default_str();
    app.add_option("--seed", params.tree.seed, "Set the random seed.")
        ->type_name("N")
        ->check(is_seed)
        ->capture_default_str();
    add_json_option(app, session);
    app.footer("Refines a generator until the outlet has the given order, then prints the streams of each order and "
               "the side branches per stream next to Tokunaga's law. A word starts at the outlet and goes upstream: F "
               "is a link, G a source link, [ and ] enclose a branch, + and - turn left and right.\n\n"
               "Examples:\n"
               "  thalweg grow --order 8\n"
               "  thalweg grow --generator 4 --order 6 --seed 3 --json\n"
               "  thalweg grow --lsystem --order 3\n"
               "  thalweg grow --rules rules.txt -o word.svg\n\n"
               "In a rules file capital letters draw a step, small letters make one without drawing, + and - turn, | "
               "turns round, [ and ] enclose a branch; # begins a comment. Of several lines for one sign each is as "
               "likely.\n");
    return [options, generator, order, rule, &session] {
        options->shapes_tree = generator->count() + order->count() + rule->count() > 0;
        return grow(*options, session);
    };
}

} // namespace thalweg::tools
