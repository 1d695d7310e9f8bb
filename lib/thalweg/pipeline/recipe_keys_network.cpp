// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/key_kinds.hpp>
#include <thalweg/pipeline/recipe_sections.hpp>

namespace thalweg::pipeline {

void add_network_keys(std::vector<Key>& keys) {
    using network::BranchChoice;
    using network::Orientation;
    using network::VisitRule;
    keys.push_back(choice<Source>("network.source", {{"dla", Source::dla}, {"lines", Source::lines}},
                                  "where the rivers come from: grown, or a file's lines",
                                  in_network<Source>([](NetworkRecipe& n) -> Source& { return n.source; })));
    {
        Key key = number("network.prune", "cells", {0, 1e7}, "L: no leaf arc shorter than this is left",
                         in_network<double>([](NetworkRecipe& n) -> double& {
                             if (!n.prune_cells) {
                                 n.prune_cells = 0.0;
                             }
                             return *n.prune_cells;
                         }));
        key.take = [](Recipe const& r) -> std::optional<Value> {
            return r.network && r.network->prune_cells ? std::optional<Value>(*r.network->prune_cells) : std::nullopt;
        };
        keys.push_back(std::move(key));
    }
    keys.push_back(choice<Heights>("network.heights",
                                   {{"auto", Heights::automatic},
                                    {"straight", Heights::straight},
                                    {"straight_repaired", Heights::straight_repaired},
                                    {"along_stream", Heights::along_stream},
                                    {"file", Heights::file}},
                                   "heights of the rivers; auto: file where lines carry Z, else straight_repaired",
                                   in_network<Heights>([](NetworkRecipe& n) -> Heights& { return n.heights; })));
    keys.push_back(number("network.slope", "m/m", {0, 10, true}, "s: fall of the valleys",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.slope; })));

    keys.push_back(integer<std::int64_t>(
        "network.dla.particles", "", {1, 1e9}, "size of the cluster",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.dla.particles; })));
    keys.push_back(number("network.dla.sticking", "", {0, 1, true}, "S: a site with n neighbours holds with S^(3-n)",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.dla.sticking; })));
    keys.push_back(integer<int>("network.dla.visits", "", {1, 255}, "M: arrivals a site needs before it may hold",
                                in_network<int>([](NetworkRecipe& n) -> int& { return n.dla.visits; })));
    keys.push_back(
        choice<VisitRule>("network.dla.rule",
                          {{"count_first", VisitRule::count_first}, {"stick_then_count", VisitRule::stick_then_count}},
                          "whether an arrival counts before or after its stick test",
                          in_network<VisitRule>([](NetworkRecipe& n) -> VisitRule& { return n.dla.rule; })));
    keys.push_back(
        choice<BranchChoice>("network.dla.branch",
                             {{"largest", BranchChoice::largest},
                              {"north", BranchChoice::north},
                              {"east", BranchChoice::east},
                              {"south", BranchChoice::south},
                              {"west", BranchChoice::west},
                              {"all", BranchChoice::all}},
                             "which arm of the cluster becomes the valley",
                             in_network<BranchChoice>([](NetworkRecipe& n) -> BranchChoice& { return n.branch; })));

    keys.push_back(text("network.lines.path", "file name", "any OGR source of lines",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.path; })));
    keys.push_back(text("network.lines.layer", "name", "\"\" takes the only line layer",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.layer; })));
    keys.push_back(text("network.lines.type_field", "name", "field with the river type; need not exist",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.type_field; })));
    keys.push_back(text("network.lines.rank_field", "name",
                        "integer field that falls downstream; \"\" takes hydroseq where there is one",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.rank_field; })));
    keys.push_back(number("network.lines.snap", "m", {0, 1e6}, "ends closer than this are joined; 0: 1e-6 of the box",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.lines.snap_m; })));
    keys.push_back(choice<Orientation>(
        "network.lines.orientation",
        {{"auto", Orientation::automatic},
         {"height", Orientation::height},
         {"rank", Orientation::rank},
         {"as_drawn", Orientation::as_drawn},
         {"topology", Orientation::topology}},
        "what tells which way a line runs",
        in_network<Orientation>([](NetworkRecipe& n) -> Orientation& { return n.lines.orientation; })));
}

} // namespace thalweg::pipeline
