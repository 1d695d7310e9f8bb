// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/key_kinds.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_sections.hpp>

namespace thalweg::pipeline {

namespace {

void add_rosgen_keys(std::vector<Key>& keys) {
    using MaybeType = std::optional<network::Rosgen>;
    Choices<MaybeType> types{{"by_order", std::nullopt}};
    for (network::Rosgen const type : network::rosgen_types) {
        types.emplace_back(network::name_of(type), type);
    }
    keys.push_back(choice<MaybeType>("network.rosgen", types,
                                     "Rosgen type of rivers without one: by Strahler order, or one type for all",
                                     in_network<MaybeType>([](NetworkRecipe& n) -> MaybeType& { return n.rosgen; })));
    keys.push_back(choice<network::SlopeDraw>(
        "network.rosgen_slope", {{"middle", network::SlopeDraw::middle}, {"uniform", network::SlopeDraw::uniform}},
        "slope of a river within its type's range: the usual value, or a random one",
        in_network<network::SlopeDraw>([](NetworkRecipe& n) -> network::SlopeDraw& { return n.rosgen_slope; })));
    keys.push_back(number("network.coast", "m", {0, 1e9},
                          "rivers closer to their outlet than this, along the stream, are marked as braided",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.coast_m; })));
}

void add_tokunaga_keys(std::vector<Key>& keys) {
    using network::SideRule;
    keys.push_back(integer<int>("network.tokunaga.generator", "", {1, 50},
                                "lambda of the tree, and of strokes without their own: 1 has no side branches, 2 is "
                                "dendritic, larger values are feathered",
                                in_network<int>([](NetworkRecipe& n) -> int& { return n.tokunaga.generator; })));
    keys.push_back(integer<int>("network.tokunaga.order", "", {1, 12},
                                "Strahler order at the outlet; with strokes, that of one as long as the grid is wide",
                                in_network<int>([](NetworkRecipe& n) -> int& { return n.tokunaga.order; })));
    keys.push_back(choice<SideRule>(
        "network.tokunaga.rule",
        {{"tokunaga", SideRule::tokunaga}, {"constant", SideRule::constant}, {"plane", SideRule::plane}},
        "number of side branches of a link: by its order, constant as published, or such that the fractal dimension is "
        "2",
        in_network<SideRule>([](NetworkRecipe& n) -> SideRule& { return n.tokunaga.rule; })));
    keys.push_back(
        choice<Side>("network.tokunaga.mouth",
                     {{"north", Side::north}, {"east", Side::east}, {"south", Side::south}, {"west", Side::west}},
                     "side of the grid or region where the river leaves",
                     in_network<Side>([](NetworkRecipe& n) -> Side& { return n.tokunaga.mouth; })));
    keys.push_back(file("network.tokunaga.region", "polygon that the network fills; \"\": the grid",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.tokunaga.region; })));
    keys.push_back(
        file("network.tokunaga.strokes",
             "lines drawn from outlet to source, each of which grows a network; \"\": one network in the region",
             in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.tokunaga.strokes; })));
    keys.push_back(text("network.tokunaga.layer", "name", "layer of the strokes; \"\": the only line layer",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.tokunaga.layer; })));
    keys.push_back(number("network.tokunaga.spacing", "cells", {0, 1e6},
                          "minimum distance between links; closer ones are left out",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.tokunaga.spacing_cells; })));
}

/// Where rivers run once they are there.
void add_course_keys(std::vector<Key>& keys) {
    using MaybeNumber = std::optional<double>;
    keys.push_back(maybe("network.rotate", "degrees", {-180, 180},
                         "rotation of the cluster, counterclockwise; left out: random with equilibrium, else 0",
                         in_network<MaybeNumber>([](NetworkRecipe& n) -> MaybeNumber& { return n.rotate_deg; })));
    keys.push_back(maybe("network.meander", "", {0, 2},
                         "meander amplitude, 1 as in nature; left out: 1 for grown rivers with equilibrium, else 0",
                         in_network<MaybeNumber>([](NetworkRecipe& n) -> MaybeNumber& { return n.meander; })));
    keys.push_back(choice<InlandEnds>(
        "network.inland", {{"carry", InlandEnds::carry}, {"sink", InlandEnds::sink}, {"coast", InlandEnds::coast}},
        "rivers that end inside the grid: extend them to its border or the sea, keep them as sinks, "
        "or take their ends for mouths on a coast and make what lies before them the sea",
        in_network<InlandEnds>([](NetworkRecipe& n) -> InlandEnds& { return n.inland; })));
    keys.push_back(yes_no("network.fill_space", "add the side valleys of the terrain to the network as arcs",
                          in_network<bool>([](NetworkRecipe& n) -> bool& { return n.fill_space; })));
    keys.push_back(integer<std::int64_t>(
        "network.support", "cells", {1, 1e9}, "drainage area at which a side valley begins",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.support_cells; })));
}

} // namespace

void add_network_keys(std::vector<Key>& keys) {
    using network::BranchChoice;
    using network::Orientation;
    using network::VisitRule;
    keys.push_back(choice<Source>(
        "network.source",
        {{"dla", Source::dla}, {"tokunaga", Source::tokunaga}, {"forest", Source::forest}, {"lines", Source::lines}},
        "where the rivers come from: a DLA cluster, a Tokunaga tree, a forest of trees that grow inland from a coast, "
        "or lines of a file",
        in_network<Source>([](NetworkRecipe& n) -> Source& { return n.source; })));
    {
        Key key = number("network.prune", "cells", {0, 1e7}, "length threshold: shorter leaf arcs are removed",
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
    keys.push_back(
        choice<Heights>("network.heights",
                        {{"auto", Heights::automatic},
                         {"straight", Heights::straight},
                         {"straight_repaired", Heights::straight_repaired},
                         {"along_stream", Heights::along_stream},
                         {"rosgen", Heights::rosgen},
                         {"graded", Heights::graded},
                         {"file", Heights::file},
                         {"soft", Heights::soft},
                         {"fixed", Heights::fixed},
                         {"ends", Heights::ends}},
                        "elevations of the rivers. auto: file where the lines have Z, else graded with equilibrium and "
                        "straight_repaired otherwise. With equilibrium, soft, fixed and ends take those of the file or "
                        "straight_repaired: as upper bounds, as they are, or only at sources and outlets",
                        in_network<Heights>([](NetworkRecipe& n) -> Heights& { return n.heights; })));
    keys.push_back(number("network.slope", "m/m", {0, 10, true},
                          "channel slope s; with graded heights the mean slope of the main stem",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.slope; })));
    keys.push_back(number("network.concavity", "", {0, 1},
                          "concavity theta of graded rivers and of equilibrium terrain: slope ~ area^-theta",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.concavity; })));
    add_course_keys(keys);
    add_rosgen_keys(keys);

    keys.push_back(integer<std::int64_t>(
        "network.dla.particles", "", {1, 1e9}, "number of particles in the cluster",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.dla.particles; })));
    keys.push_back(integer<std::int64_t>(
        "network.dla.radius", "cells", {0, 1e6}, "radius of the cluster at which growth stops early; 0: none",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.dla.max_radius; })));
    keys.push_back(number("network.dla.sticking", "", {0, 1, true},
                          "sticking probability S: a particle with n occupied neighbours sticks with S^(3-n)",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.dla.sticking; })));
    keys.push_back(integer<int>("network.dla.visits", "", {1, 255},
                                "noise-reduction count M: arrivals that a site needs before it is occupied",
                                in_network<int>([](NetworkRecipe& n) -> int& { return n.dla.visits; })));
    keys.push_back(
        choice<VisitRule>("network.dla.rule",
                          {{"count_first", VisitRule::count_first}, {"stick_then_count", VisitRule::stick_then_count}},
                          "whether an arrival counts before or after its sticking test",
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

    add_tokunaga_keys(keys);
    add_forest_keys(keys);

    keys.push_back(file("network.lines.path", "file of lines: GeoPackage, Shapefile, GeoJSON, ...",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.path; })));
    keys.push_back(text("network.lines.layer", "name", "layer of the lines; \"\": the only line layer",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.layer; })));
    keys.push_back(text("network.lines.type_field", "name",
                        "field with the river type; the field rosgen may be missing",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.type_field; })));
    keys.push_back(
        text("network.lines.rank_field", "name",
             "integer field that decreases downstream, and is least on the main of several branches; \"\": hydroseq "
             "where there is one",
             in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.rank_field; })));
    keys.push_back(number("network.lines.snap", "m", {0, 1e6},
                          "line ends closer than this are joined; 0: 1e-6 of the extent",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.lines.snap_m; })));
    keys.push_back(choice<Orientation>(
        "network.lines.orientation",
        {{"auto", Orientation::automatic},
         {"height", Orientation::height},
         {"rank", Orientation::rank},
         {"as_drawn", Orientation::as_drawn},
         {"topology", Orientation::topology}},
        "what decides the flow direction of a line",
        in_network<Orientation>([](NetworkRecipe& n) -> Orientation& { return n.lines.orientation; })));
    keys.push_back(choice<network::Divergences>(
        "network.lines.divergences", {{"main", network::Divergences::main}, {"error", network::Divergences::error}},
        "where water could go more than one way: keep the main path and report the other branches as secondary, or "
        "refuse the file",
        in_network<network::Divergences>(
            [](NetworkRecipe& n) -> network::Divergences& { return n.lines.divergences; })));
    keys.push_back(choice<io::LineFilter>(
        "network.lines.filter", {{"natural", io::LineFilter::natural}, {"none", io::LineFilter::none}},
        "natural leaves out canals, ditches, pipes, weirs and coastlines, as the fields of OSM and NHD name them; none "
        "keeps all lines",
        in_network<io::LineFilter>([](NetworkRecipe& n) -> io::LineFilter& { return n.lines.filter; })));
    keys.push_back(choice<Coastlines>(
        "network.lines.coastlines", {{"sea", Coastlines::sea}, {"none", Coastlines::none}},
        "coastlines among the lines: sea, beyond them is the sea, where rivers end; none, they mean nothing",
        in_network<Coastlines>([](NetworkRecipe& n) -> Coastlines& { return n.lines.coastlines; })));
}

} // namespace thalweg::pipeline
