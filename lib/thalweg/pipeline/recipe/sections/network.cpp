// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/check_recipe.hpp>
#include <thalweg/pipeline/recipe/internal/key_rows.hpp>

namespace thalweg::pipeline {
namespace {

/// Whether rivers have these heights, or may have them once their file is read.
bool may_be(Recipe const& r, Heights heights) {
    if (!r.network) {
        return false;
    }
    if (r.network->heights != Heights::automatic) {
        return r.network->heights == heights;
    }
    return heights == (in_equilibrium(r) ? Heights::graded : Heights::straight_repaired) ||
           (heights == Heights::file && r.network->source == Source::lines);
}

Use by_slope() {
    return when("network.heights other than \"rosgen\", and other than \"graded\" with surface.method = "
                "\"equilibrium\", whose rivers are graded with the terrain",
                [](Recipe const& r) {
                    bool const by_terrain = in_equilibrium(r);
                    bool found = by_terrain ? false : may_be(r, Heights::graded);
                    for (Heights const h : {Heights::straight, Heights::straight_repaired, Heights::along_stream,
                                            Heights::file, Heights::soft, Heights::fixed, Heights::ends}) {
                        found = found || may_be(r, h);
                    }
                    return found;
                });
}

Use is_graded() {
    return when("network.heights = \"graded\"", [](Recipe const& r) { return may_be(r, Heights::graded); });
}

Use given_heights() {
    return is("network.heights", {"auto", "file", "soft", "fixed"});
}

Use rosgen_heights() {
    return is("network.heights", {"rosgen"});
}

/// Where rivers come from, and their heights.
Rows<NetworkRecipe> source_keys() {
    return {
        choice("source", &NetworkRecipe::source)
            .one_of({{"dla", Source::dla},
                     {"tokunaga", Source::tokunaga},
                     {"forest", Source::forest},
                     {"lines", Source::lines}})
            .means("where the rivers come from: a DLA cluster, a Tokunaga tree, a forest of trees that grow inland "
                   "from a coast, or lines of a file"),
        number("prune", &NetworkRecipe::prune_cells)
            .unit("cells")
            .range({0, 1e7})
            .standard("20 for dla and forest, else 0")
            .means("length threshold: shorter leaf arcs are removed"),
        choice("heights", &NetworkRecipe::heights)
            .one_of({{"auto", Heights::automatic},
                     {"straight", Heights::straight},
                     {"straight_repaired", Heights::straight_repaired},
                     {"along_stream", Heights::along_stream},
                     {"rosgen", Heights::rosgen},
                     {"graded", Heights::graded},
                     {"file", Heights::file},
                     {"soft", Heights::soft},
                     {"fixed", Heights::fixed},
                     {"ends", Heights::ends}})
            .means("elevations of the rivers. auto: file where the lines have Z, else graded with equilibrium and "
                   "straight_repaired otherwise. With equilibrium, soft, fixed and ends take those of the file or "
                   "straight_repaired: as upper bounds, as they are, or only at sources and outlets"),
        number("slope", &NetworkRecipe::slope)
            .unit("m/m")
            .range({0, 10, left_open})
            .used(by_slope())
            .means("channel slope s; with graded heights the mean slope of the main stem"),
        number("heights_tolerance", &NetworkRecipe::heights_tolerance_m)
            .unit("m")
            .range({0, 1e4})
            .used(source_is("lines") && given_heights())
            .means("vertices whose heights in the file dem.tif misses by more, beside what the river falls within a "
                   "cell, are counted in a warning"),
        number("concavity", &NetworkRecipe::concavity)
            .range({0, 1})
            .earlier(0.45)
            .used(is_graded() || by_equilibrium())
            .means("concavity theta of graded rivers and of equilibrium terrain: slope ~ area^-theta"),
    };
}

/// Where rivers run once they are there.
Rows<NetworkRecipe> course_keys() {
    return {
        number("rotate", &NetworkRecipe::rotate_deg)
            .unit("degrees")
            .range({-180, 180})
            .used(source_is("dla"))
            .means("rotation of the cluster, counterclockwise; left out: random with equilibrium, else 0"),
        number("meander", &NetworkRecipe::meander)
            .range({0, 2})
            .means("meander amplitude, 1 as in nature; left out: 1 for grown rivers with equilibrium, 0.3 where they "
                   "end on a coast, else 0"),
        choice("inland", &NetworkRecipe::inland)
            .one_of({{"carry", InlandEnds::carry}, {"sink", InlandEnds::sink}, {"coast", InlandEnds::coast}})
            .used(by_equilibrium() && is("network.source", {"dla", "tokunaga", "lines"}))
            .means("rivers that end inside the grid: extend them to its border or the sea, keep them as sinks, "
                   "or take their ends for mouths on a coast and make what lies before them the sea"),
        yes_no("fill_space", &NetworkRecipe::fill_space)
            .used(by_equilibrium())
            .means("add the side valleys of the terrain to the network as arcs"),
        number("support", &NetworkRecipe::support_cells)
            .unit("cells")
            .range({1, 1e9})
            .used(by_equilibrium() && is("network.fill_space", {"true"}))
            .means("drainage area at which a side valley begins"),
    };
}

Choices<std::optional<network::Rosgen>> rosgen_choices() {
    Choices<std::optional<network::Rosgen>> types{{"by_order", std::nullopt}};
    for (network::Rosgen const type : network::rosgen_types) {
        types.emplace_back(network::name_of(type), type);
    }
    return types;
}

Rows<NetworkRecipe> rosgen_keys() {
    using network::SlopeDraw;
    return {
        choice("rosgen", &NetworkRecipe::rosgen)
            .one_of(rosgen_choices())
            .used(rosgen_heights() || above("network.coast", 0.0))
            .means("Rosgen type of rivers without one: by Strahler order, or one type for all"),
        choice("rosgen_slope", &NetworkRecipe::rosgen_slope)
            .one_of({{"middle", SlopeDraw::middle}, {"uniform", SlopeDraw::uniform}})
            .used(rosgen_heights())
            .means("slope of a river within its type's range: the usual value, or a random one"),
        number("coast", &NetworkRecipe::coast_m)
            .unit("m")
            .range({0, 1e9})
            .means("rivers closer to their outlet than this, along the stream, are marked as braided"),
    };
}

Rows<network::DlaParams> growth_keys() {
    using network::DlaParams;
    using network::VisitRule;
    return {
        number("particles", &DlaParams::particles)
            .range({1, 1e9})
            .used(source_is("dla"))
            .means("number of particles in the cluster"),
        number("radius", &DlaParams::max_radius)
            .unit("cells")
            .range({0, 1e6})
            .used(source_is("dla"))
            .means("radius of the cluster at which growth stops early; 0: none"),
        number("sticking", &DlaParams::sticking)
            .range({0, 1, left_open})
            .used(source_is("dla"))
            .means("sticking probability S: a particle with n occupied neighbours sticks with S^(3-n)"),
        number("visits", &DlaParams::visits)
            .range({1, 255})
            .used(source_is("dla"))
            .means("noise-reduction count M: arrivals that a site needs before it is occupied"),
        choice("rule", &DlaParams::rule)
            .one_of({{"count_first", VisitRule::count_first}, {"stick_then_count", VisitRule::stick_then_count}})
            .used(source_is("dla") && above("network.dla.visits", 1.0) &&
                  when("network.dla.sticking < 1",
                       [](Recipe const& r) { return r.network && r.network->dla.sticking < 1.0; }))
            .means("whether an arrival counts before or after its sticking test"),
    };
}

Rows<NetworkRecipe> dla_keys() {
    using network::BranchChoice;
    return joined<NetworkRecipe>({inside("dla.", &NetworkRecipe::dla, growth_keys()),
                                  {choice("dla.branch", &NetworkRecipe::branch)
                                       .one_of({{"largest", BranchChoice::largest},
                                                {"north", BranchChoice::north},
                                                {"east", BranchChoice::east},
                                                {"south", BranchChoice::south},
                                                {"west", BranchChoice::west},
                                                {"all", BranchChoice::all}})
                                       .used(source_is("dla"))
                                       .means("which arm of the cluster becomes the valley")}});
}

Rows<TokunagaRecipe> tokunaga_keys() {
    using network::SideRule;
    Use const grown = source_is("tokunaga");
    Use const strokes = grown && given("network.tokunaga.strokes");
    Use const no_strokes = grown && not_given("network.tokunaga.strokes");
    return {
        number("generator", &TokunagaRecipe::generator)
            .range({1, 50})
            .used(grown)
            .means("lambda of the tree, and of strokes without their own: 1 has no side branches, 2 is dendritic, "
                   "larger values are feathered"),
        number("order", &TokunagaRecipe::order)
            .range({1, 12})
            .used(grown)
            .means("Strahler order at the outlet; with strokes, that of one as long as the grid is wide"),
        choice("rule", &TokunagaRecipe::rule)
            .one_of({{"tokunaga", SideRule::tokunaga}, {"constant", SideRule::constant}, {"plane", SideRule::plane}})
            .used(no_strokes)
            .means("number of side branches of a link: by its order, constant as published, or such that the fractal "
                   "dimension is 2"),
        choice("mouth", &TokunagaRecipe::mouth)
            .one_of({{"north", Side::north}, {"east", Side::east}, {"south", Side::south}, {"west", Side::west}})
            .used(no_strokes)
            .means("side of the grid or region where the river leaves"),
        file("region", &TokunagaRecipe::region).used(grown).means("polygon that the network fills; \"\": the grid"),
        file("strokes", &TokunagaRecipe::strokes)
            .used(grown)
            .means("lines drawn from outlet to source, each of which grows a network; \"\": one network in the region"),
        text("layer", &TokunagaRecipe::layer)
            .form("name")
            .used(strokes)
            .means("layer of the strokes; \"\": the only line layer"),
        number("spacing", &TokunagaRecipe::spacing_cells)
            .unit("cells")
            .range({0, 1e6})
            .used(grown)
            .means("minimum distance between links; closer ones are left out"),
    };
}

Rows<ForestRecipe> forest_keys() {
    using network::ForestParams;
    Use const grown = source_is("forest");
    Use const shaped = grown && not_given("network.forest.region");
    return {
        choice("shape", &ForestRecipe::shape)
            .one_of({{"grid", LandShape::grid}, {"island", LandShape::island}})
            .used(shaped)
            .means("extent of the land where no region is given: the whole grid, or an island in it"),
        number("ruggedness", &ForestRecipe::ruggedness)
            .range({0, 1})
            .used(shaped && is("network.forest.shape", {"island"}))
            .means("how far fjords and capes of the island reach"),
        file("region", &ForestRecipe::region)
            .used(grown)
            .means("polygons that are land, with sea around them; \"\": see shape"),
        file("outlets", &ForestRecipe::outlets)
            .used(grown)
            .means("where rivers reach the coast: points, lines along the coast, or polygons of water; \"\": anywhere "
                   "on the coast"),
        number("seeds", &ForestRecipe::seeds)
            .range({0, 1e6})
            .used(grown)
            .means("number of outlets at random places on the coast; 0: see outlet_spacing"),
        number("outlet_spacing", &ForestRecipe::outlet_spacing_cells)
            .unit("cells")
            .range({0, 1e6})
            .used(grown && is("network.forest.seeds", {"0"}))
            .means("coast, or border of the grid, for each outlet; 0: six spacings of rivers"),
        number("spacing", &ForestRecipe::spacing_cells)
            .unit("cells")
            .range({8, 200})
            .used(grown)
            .means("minimum distance between rivers that do not meet"),
        number("particles", &ForestRecipe::growth, &ForestParams::particles)
            .range({0, 1e9})
            .used(grown)
            .means("number of particles of all trees; 0: until the land is full"),
        number("sticking", &ForestRecipe::growth, &ForestParams::sticking)
            .range({0, 1, left_open})
            .used(grown)
            .means("sticking probability"),
        number("visits", &ForestRecipe::growth, &ForestParams::visits)
            .range({1, 255})
            .used(grown)
            .means("noise-reduction count M: arrivals that a cell needs before it is occupied; larger values make "
                   "straighter rivers"),
    };
}

Use by_rank() {
    return source_is("lines") &&
           (is("network.lines.orientation", {"auto", "rank"}) ||
            (is("network.lines.orientation", {"height", "as_drawn"}) && is("network.lines.divergences", {"main"})));
}

Use by_links() {
    return source_is("lines") &&
           (is("network.lines.orientation", {"auto"}) || is("network.lines.divergences", {"main"}));
}

/// What is read.
Rows<LinesRecipe> field_keys() {
    return {
        file("path", &LinesRecipe::path)
            .layer(&LinesRecipe::layer)
            .kept_in("")
            .used(source_is("lines"))
            .means("file of lines: GeoPackage, Shapefile, GeoJSON, ..."),
        text("layer", &LinesRecipe::layer)
            .form("name")
            .used(source_is("lines"))
            .means("layer of the lines; \"\": the only line layer"),
        text("source_crs", &LinesRecipe::source_crs)
            .form("EPSG code or WKT")
            .used(source_is("lines"))
            .means("coordinate system of a line file that has none; \"\": such a file is refused"),
        text("type_field", &LinesRecipe::type_field)
            .form("name")
            .used(source_is("lines"))
            .means("field with the river type; the field rosgen may be missing"),
        text("rank_field", &LinesRecipe::rank_field)
            .form("name")
            .used(by_rank())
            .means("integer field that decreases downstream, and is least on the main of several branches; \"\": "
                   "hydroseq where there is one"),
        text("id_field", &LinesRecipe::id_field)
            .form("name")
            .used(by_links())
            .means("field with the id of a line, for down_field; \"\": a known one (docs/river_files.md)"),
        text("down_field", &LinesRecipe::down_field)
            .form("name")
            .used(by_links())
            .means("field with the id of the line downstream; \"\": a known one (docs/river_files.md)"),
    };
}

/// What becomes of it.
Rows<LinesRecipe> adoption_keys() {
    using network::Divergences;
    using network::Orientation;
    return {
        number("snap", &LinesRecipe::snap_m)
            .unit("m")
            .range({0, 1e6})
            .used(source_is("lines"))
            .means("line ends closer than this are joined; 0: 1e-6 of the extent"),
        choice("orientation", &LinesRecipe::orientation)
            .one_of({{"auto", Orientation::automatic},
                     {"height", Orientation::height},
                     {"rank", Orientation::rank},
                     {"as_drawn", Orientation::as_drawn},
                     {"topology", Orientation::topology}})
            .used(source_is("lines"))
            .means("what decides the flow direction of a line; auto: links, a direction column, Z or ranks, and else "
                   "angles at confluences, the border, the drawn direction and network.lines.dem together"),
        file("dem", &LinesRecipe::dem)
            .used(source_is("lines") && is("network.lines.orientation", {"auto"}))
            .means("DEM of the land that the lines are of, in any CRS, for the flow direction of lines: together with "
                   "angles at confluences, where fields and Z do not tell it"),
        choice("divergences", &LinesRecipe::divergences)
            .one_of({{"main", Divergences::main}, {"error", Divergences::error}})
            .used(source_is("lines"))
            .means("where water could go more than one way: keep the main path and report the other branches as "
                   "secondary, or refuse the file"),
        choice("filter", &LinesRecipe::filter)
            .one_of({{"natural", io::LineFilter::natural}, {"none", io::LineFilter::none}})
            .used(source_is("lines"))
            .means("natural leaves out canals, ditches, pipes, weirs and coastlines, as the fields of OSM and NHD name "
                   "them; none keeps all lines"),
        choice("coastlines", &LinesRecipe::coastlines)
            .one_of({{"sea", Coastlines::sea}, {"none", Coastlines::none}})
            .used(source_is("lines") && is("network.lines.filter", {"natural"}))
            .means("coastlines among the lines: sea, beyond them is the sea, where rivers end; none, they mean "
                   "nothing"),
        number("keep", &LinesRecipe::keep)
            .range({0, 1})
            .used(source_is("lines"))
            .means("least share of the given length that must be in the network (check given_length): without what "
                   "filter, coastlines, divergences, duplicates, the grid and network.prune leave out"),
    };
}

Rows<LinesRecipe> lines_keys() {
    return joined<LinesRecipe>({field_keys(), adoption_keys()});
}

} // namespace

Rows<NetworkRecipe> network_keys() {
    return joined<NetworkRecipe>({source_keys(), course_keys(), rosgen_keys(), dla_keys(),
                                  inside("tokunaga.", &NetworkRecipe::tokunaga, tokunaga_keys()),
                                  inside("forest.", &NetworkRecipe::forest, forest_keys()),
                                  inside("lines.", &NetworkRecipe::lines, lines_keys())});
}

} // namespace thalweg::pipeline
