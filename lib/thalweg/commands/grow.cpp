// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/grow.hpp>

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/growth/tokunaga/lsystem.hpp>

namespace thalweg::commands {

namespace {

GrowResult counted(growth::TokunagaTree const& tree, int generator) {
    std::vector<std::int64_t> down;
    for (growth::TreeLink const& link : tree.links) {
        down.push_back(link.down);
    }
    GrowResult grown{{}, 0, network::count_streams(down), growth::tokunaga_laws(generator), {}, {}};
    double side = grown.laws.a;
    for (std::size_t k = 0; k < grown.streams.side.size(); ++k, side *= grown.laws.c) {
        grown.side_law.push_back(side);
    }
    std::vector<std::int64_t> const& streams = grown.streams.streams;
    for (std::size_t w = 0; w + 1 < streams.size(); ++w) {
        grown.bifurcation.push_back(static_cast<double>(streams[w]) / static_cast<double>(streams[w + 1]));
    }
    return grown;
}

draw::Format format_of_picture(std::string const& path) {
    for (auto const& [ending, format] : {std::pair{std::string_view(".svg"), draw::Format::svg},
                                         {".png", draw::Format::png},
                                         {".pdf", draw::Format::pdf}}) {
        if (path.size() > ending.size() && path.ends_with(ending)) {
            return format;
        }
    }
    throw BadParameter("commands.run_grow",
                       fmt::format("'{}' is not a picture: end its name in .svg, .png or .pdf", path));
}

GrowResult rewritten(GrowParams const& params, Run const& run) {
    constexpr std::int64_t most_bytes = 1 << 20;
    growth::LSystem const system = growth::read_rules(io::read_text(params.rules, most_bytes), params.rules);
    GrowResult grown;
    grown.word = growth::rewrite(system, params.tree.seed, run);
    if (!params.output.empty()) {
        auto const lines = growth::draw_word(grown.word, system.angle_deg, run);
        grown.lines = static_cast<std::int64_t>(lines.size());
        draw::LinesParams look;
        look.format = format_of_picture(params.output);
        io::OutputFile file(params.output, params.existing);
        io::write_text(file.staging(), draw::lines(lines, look).bytes);
        file.commit();
    }
    return grown;
}

} // namespace

GrowResult run_grow(GrowParams const& params, Run const& run) {
    if (!params.rules.empty()) {
        return rewritten(params, run);
    }
    refuse_if<BadParameter>(!params.output.empty(), "commands.run_grow",
                            "-o draws the word of --rules FILE: give both");
    if (params.word) {
        growth::TokunagaParams tree = params.tree;
        tree.banks = growth::BankRule::alternating; // the rules define the sides
        GrowResult grown;
        grown.word = growth::lsystem(tree, run);
        return grown;
    }
    return counted(growth::grow_tokunaga(params.tree, run), params.tree.generator);
}

} // namespace thalweg::commands
