// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/network/growth/tokunaga/lsystem.hpp>
#include <thalweg/network/order/order.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"

namespace thalweg::tools {

namespace {

struct GrowOptions {
    network::TokunagaParams params;
    std::string rule = "tokunaga";
    bool lsystem = false;
    std::string rules;
    std::string picture;
    bool overwrite = false;
    bool shapes_tree = false; ///< --generator, --order or --rule is given
};

network::SideRule rule_of(std::string const& word) {
    return word == "constant" ? network::SideRule::constant
           : word == "plane"  ? network::SideRule::plane
                              : network::SideRule::tokunaga;
}

/// Measured statistics, and those predicted by the closed forms.
struct Count {
    network::StreamCounts streams;
    network::TokunagaLaws laws;
    std::vector<double> side_law;    ///< by k - 1: a c^(k-1)
    std::vector<double> bifurcation; ///< by order - 1: N_w / N_(w+1)
};

Count count(network::TokunagaTree const& tree, int generator) {
    std::vector<std::int64_t> down;
    for (network::TreeLink const& link : tree.links) {
        down.push_back(link.down);
    }
    Count c{network::count_streams(down), network::tokunaga_laws(generator), {}, {}};
    double side = c.laws.a;
    for (std::size_t k = 0; k < c.streams.side.size(); ++k, side *= c.laws.c) {
        c.side_law.push_back(side);
    }
    for (std::size_t w = 0; w + 1 < c.streams.streams.size(); ++w) {
        c.bifurcation.push_back(static_cast<double>(c.streams.streams[w]) /
                                static_cast<double>(c.streams.streams[w + 1]));
    }
    return c;
}

void print_json(GrowOptions const& options, Count const& c) {
    nlohmann::ordered_json const out{{"generator", options.params.generator},
                                     {"order", c.streams.order},
                                     {"rule", options.rule},
                                     {"seed", options.params.seed},
                                     {"links", c.streams.links},
                                     {"sources", c.streams.sources},
                                     {"streams", c.streams.streams},
                                     {"side_branches", c.streams.side},
                                     {"side_branches_law", c.side_law},
                                     {"bifurcation", c.bifurcation},
                                     {"bifurcation_law", c.laws.bifurcation}};
    fmt::print("{}\n", out.dump());
}

void print_table(Count const& c) {
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

draw::Format format_of(std::string const& path) {
    auto const ends = [&](std::string_view ending) {
        return path.size() > ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
    };
    refuse_if<BadParameter>(!ends(".svg") && !ends(".png") && !ends(".pdf"),
                            "'{}' is not a picture: end its name in .svg, .png or .pdf", path);
    return ends(".svg") ? draw::Format::svg : ends(".png") ? draw::Format::png : draw::Format::pdf;
}

void write_picture(GrowOptions const& options, std::vector<std::vector<Vec2>> const& lines) {
    draw::LinesParams look;
    look.format = format_of(options.picture);
    io::OutputFile file(options.picture, options.overwrite ? io::Existing::replace : io::Existing::refuse);
    io::write_text(file.staging(), draw::lines(lines, look).bytes);
    file.commit();
}

/// Rewrites the word of a rules file and draws or prints it.
int rewrite_rules(GrowOptions const& options, Session const& session) {
    constexpr std::int64_t most_bytes = 1 << 20;
    refuse_if<BadParameter>(options.shapes_tree,
                            "--generator, --order and --rule are those of Tokunaga networks: --rules has its own");
    refuse_if<BadParameter>(options.picture.empty() == !options.lsystem,
                            "--rules needs --lsystem, to print the word, or -o FILE, to draw it");
    network::LSystem const system = network::read_rules(io::read_text(options.rules, most_bytes), options.rules);
    std::string const word = network::rewrite(system, options.params.seed, session.run);
    if (options.picture.empty()) {
        fmt::print("{}\n", word);
        return Exit::done;
    }
    auto const lines = network::draw_word(word, system.angle_deg, session.run);
    write_picture(options, lines);
    if (session.json) {
        nlohmann::ordered_json const out{{"file", options.picture}, {"signs", word.size()}, {"lines", lines.size()}};
        fmt::print("{}\n", out.dump());
    } else {
        fmt::print("{}\n", options.picture);
    }
    return Exit::done;
}

int grow(GrowOptions const& options, Session const& session) {
    if (!options.rules.empty()) {
        return rewrite_rules(options, session);
    }
    refuse_if<BadParameter>(!options.picture.empty(), "-o draws the word of --rules FILE: give both");
    network::TokunagaParams params = options.params;
    params.rule = rule_of(options.rule);
    if (options.lsystem) {
        refuse_if<BadParameter>(session.json, "thalweg grow prints a word or JSON: give --lsystem or --json, not both");
        params.banks = network::BankRule::alternating; // the rules define the sides
        fmt::print("{}\n", network::lsystem(params, session.run));
        return Exit::done;
    }
    Count const counted = count(network::grow_tokunaga(params, session.run), params.generator);
    if (session.json) {
        print_json(options, counted);
    } else {
        print_table(counted);
    }
    return Exit::done;
}

} // namespace

Command add_grow(CLI::App& app, Session& session) {
    auto const options = std::make_shared<GrowOptions>();
    network::TokunagaParams& params = options->params;
    app.add_flag("--lsystem", options->lsystem, "Print the network as an L-system word on one line.");
    app.add_option("--rules", options->rules,
                   "Rewrite the L-system of this text file instead: lines axiom WORD, iterations N, angle DEGREES and "
                   "SIGN -> WORD.")
        ->type_name("FILE");
    app.add_option("-o,--output", options->picture, "Draw the word of --rules as this picture: .svg, .png or .pdf.")
        ->type_name("FILE");
    app.add_flag("--overwrite", options->overwrite, "Replace an existing picture.");
    CLI::Option const* const generator =
        app.add_option(
               "--generator", params.generator,
               "Use this generator (lambda), 1 to 50: 1 has no side branches, high numbers give a feathered network.")
            ->type_name("N")
            ->capture_default_str();
    CLI::Option const* const order =
        app.add_option("--order", params.order, "Set the Strahler order of the outlet, 1 to 30.")
            ->type_name("N")
            ->capture_default_str();
    CLI::Option const* const rule =
        app.add_option("--rule", options->rule, "Choose how many side branches a link gets in each refinement.")
            ->check(CLI::IsMember({"tokunaga", "constant", "plane"}))
            ->capture_default_str();
    app.add_option("--seed", params.seed, "Set the random seed.")
        ->type_name("N")
        ->check(is_seed)
        ->capture_default_str();
    app.add_flag("--json", session.json, "Print one JSON object.");
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
