// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::recipe {
namespace {

std::vector<std::string> rosgen_words() {
    std::vector<std::string> words{"by_order"};
    for (Rosgen const type : rosgen_types) {
        words.emplace_back(name_of(type));
    }
    return words;
}

std::vector<std::string> schema_names() {
    std::vector<std::string> names;
    for (io::SchemaTable const& table : io::all_schemas()) {
        names.emplace_back(table.name);
    }
    return names;
}

/// Throws what is wrong with an expression.
bool is_increment(Value const& v) {
    surface::increments(1, {std::get<std::string>(v)});
    return true;
}

template <std::size_t n, class Test> bool are_all(Value const& v, Test const& test) {
    auto const* const list = std::get_if<std::array<double, n>>(&v);
    return list != nullptr && std::all_of(list->begin(), list->end(), test);
}

bool is_near(Value const& v) {
    return are_all<2>(v, [](double x) { return std::fabs(x) <= 1e9; });
}

/// Its words are not those of its range.
bool is_corner(Value const& v) {
    if (!is_near(v)) {
        throw BadParameter("recipe.set_key",
                           fmt::format("two numbers [west, north] within 1e9 are required, not {}", toml_text(v)));
    }
    return true;
}

bool are_lengths(Value const& v) {
    return are_all<2>(v, [](double x) { return x > 0.0 && x <= 1e6; });
}

bool is_cell_number(double x) {
    return x >= 0.0 && x <= 1e6 && x == std::floor(x);
}

constexpr char const* place_words = "[z, column, row], columns and rows from 0 in the north-west";

bool is_place(Value const& v) {
    auto const* const t = std::get_if<Triple>(&v);
    return t != nullptr && std::fabs((*t)[0]) <= 1e6 && is_cell_number((*t)[1]) && (*t)[1] < 1e6 &&
           is_cell_number((*t)[2]) && (*t)[2] < 1e6;
}

bool is_window(Value const& v) {
    return are_all<4>(v, is_cell_number) && std::get<Quad>(v)[2] >= 1.0 && std::get<Quad>(v)[3] >= 1.0;
}

Condition const with_extremes = ask::given(&StatisticsRecipe::max) or ask::given(&StatisticsRecipe::min);
Condition const by_links = from_lines and (ask::is(&LinesRecipe::orientation, {network::Orientation::automatic}) or
                                           ask::is(&LinesRecipe::divergences, {network::Divergences::main}));
Condition const with_noise = with_rivers and ask::is(&SurfaceRecipe::method, {Method::diffuse}) and between_streams;
Condition const by_rough_rock = in_equilibrium and ask::above(&EquilibriumRecipe::roughness, 0);
/// Terrain that is interpolated between points, in a file or random.
Condition const from_points =
    not with_rivers and not ask::given(&SurfaceRecipe::source) and
    (not ask::has(&Recipe::statistics) or ask::is(&StatisticsRecipe::skeleton, {Prior::points}));
/// Around rivers, or between points.
Condition const by_diffusion = ask::is(&SurfaceRecipe::method, {Method::diffuse}) and (with_rivers or from_points);
/// Around rivers by a method that goes through given points and ridges.
Condition const through_features = with_rivers and ask::is(&SurfaceRecipe::method, {Method::equilibrium, Method::dilate,
                                                                                    Method::diffuse, Method::tin});
/// Around rivers by a method that honours ridges and points.
Condition const beside_rivers = (with_rivers and ask::is(&SurfaceRecipe::method, {Method::diffuse, Method::tin})) or
                                (by_dilation and ask::is(&SurfaceRecipe::base, {Base::tin}));
Condition const with_ridges = beside_rivers and between_streams;
/// Ridges or random points rise above the rivers.
Condition const above_rivers = with_ridges or (beside_rivers and ask::above(&SkeletonRecipe::scatter, 0)) or
                               (ask::given(&SkeletonRecipe::ridge_lines) and
                                ask::is(&SurfaceRecipe::method, {Method::dilate, Method::diffuse, Method::tin}));

Condition const folded = in_layers and ask::above(&StrataRecipe::fold_m, 0);
Condition const domed = in_layers and (ask::above(&StrataRecipe::dome_m, 0) or ask::below(&StrataRecipe::dome_m, 0));
Condition const faulted =
    in_layers and (ask::above(&StrataRecipe::fault_m, 0) or ask::below(&StrataRecipe::fault_m, 0));

/// Rivers fall by network.slope. Where the file of lines is still to be read, it may give them heights.
Condition falls_by_slope() {
    Condition const by_themselves = ask::is(&NetworkRecipe::heights, {Heights::automatic});
    Condition const graded = ask::is(&NetworkRecipe::heights, {Heights::graded, Heights::automatic});
    Condition const holds = with_rivers and not ask::is(&NetworkRecipe::heights, {Heights::rosgen}) and
                            not(on_raster and by_themselves) and
                            ((by_themselves and from_lines) or not(in_equilibrium and graded));
    return holds.told_as(
        R"(network.heights other than "rosgen", other than "graded" with surface.method = "equilibrium", )"
        R"(whose rivers are graded with the terrain, and other than "auto" with surface.method = "raster")");
}

Row key(char const* path, KeyKind kind, char const* unit, AllowedValues const& allowed, Condition used,
        char const* meaning, Field (*field)(Recipe&, Item), Extra const& extra = {}) {
    return {path, kind, unit, allowed, std::move(used), meaning, field, extra};
}

namespace table { // its names are for it alone

using enum KeyKind;
using namespace ask;

// path, kind, unit, what is allowed, when it has an effect, meaning, field, and what few keys have
Row const rows[] = {
    key("seed", integer, "", {0, endless}, {},
        "random seed of the whole recipe; recorded in the network's run table and, without output.title, in the "
        "titles",
        [](Recipe& r, Item) -> Field { return &r.seed; }),
    key("grid.width", integer, "cells", {1, 1e6}, {},
        "number of columns; left out: the network's extent and a margin of 5 %, or that of the DEM of "
        "surface.source",
        [](Recipe& r, Item) -> Field { return &r.grid.width; }, {.left_out_at_zero = true}),
    key("grid.height", integer, "cells", {1, 1e6}, {},
        "number of rows; left out: the network's extent and a margin of 5 %, or that of the DEM of surface.source",
        [](Recipe& r, Item) -> Field { return &r.grid.height; }, {.left_out_at_zero = true}),
    key("grid.cell", number, "m", {0, 1e6, left_open}, {}, "cell size",
        [](Recipe& r, Item) -> Field { return &r.grid.cell_m; },
        {.standard = "30, or that of the DEM of surface.source", .left_out_at_zero = true}),
    key("grid.crs", text, "", "EPSG code or WKT; projected, in metres", {},
        "coordinate system; \"\": that of the line file or the DEM of surface.source, or its UTM zone, else "
        "EPSG:32631",
        [](Recipe& r, Item) -> Field { return &r.grid.crs; }),
    key("grid.origin", pair, "m", {"[west, north]", is_corner}, {}, "north-western corner of the grid",
        [](Recipe& r, Item) -> Field { return &r.grid.origin; },
        {.standard = "[500000, 5000000], the line file's box, or that of the DEM of surface.source"}),
    key("grid.clip", yes_no, "", {"true", "false"}, from_lines or (from_forest and given(&ForestRecipe::region)),
        "cut rivers and polygons at the grid's edge, and rivers where the DEM of surface.source has no data, "
        "instead of refusing those that cross it",
        [](Recipe& r, Item) -> Field { return &r.grid.clip; }),
    key("network.source", word, "", {"dla", "tokunaga", "forest", "lines"}, {},
        "where the rivers come from: a DLA cluster, a Tokunaga tree, a forest of trees that grow inland from a "
        "coast, or lines of a file",
        [](Recipe& r, Item) -> Field { return choice(r.network->source); }),
    key("network.prune", number, "cells", {0, 1e7}, {}, "length threshold: shorter leaf arcs are removed",
        [](Recipe& r, Item) -> Field { return &r.network->prune_cells; },
        {.standard = "20 for dla and forest, else 0"}),
    key("network.heights", word, "",
        {"auto", "straight", "straight_repaired", "along_stream", "rosgen", "graded", "file", "soft", "fixed", "ends"},
        {},
        "elevations of the rivers. auto: with surface.method = \"raster\" those of the DEM, cut to fall "
        "downstream; else file where the lines have Z, graded with equilibrium and straight_repaired otherwise. "
        "With equilibrium, soft, fixed and ends take those of the file or straight_repaired: as upper bounds, as "
        "they are, or only at sources and outlets",
        [](Recipe& r, Item) -> Field { return choice(r.network->heights); }),
    key("network.slope", number, "m/m", {0, 10, left_open}, falls_by_slope(),
        "channel slope s; with graded heights the mean slope of the main stem",
        [](Recipe& r, Item) -> Field { return &r.network->slope; }),
    key("network.heights_tolerance", number, "m", {0, 1e4},
        from_lines and (is(&NetworkRecipe::heights, {Heights::file, Heights::soft, Heights::fixed}) or
                        (is(&NetworkRecipe::heights, {Heights::automatic}) and not given(&SurfaceRecipe::source))),
        "vertices whose heights in the file dem.tif misses by more, beside what the river falls within a cell, are "
        "counted in a warning",
        [](Recipe& r, Item) -> Field { return &r.network->heights_tolerance_m; }),
    key("network.concavity", number, "", {0, 1}, is(&NetworkRecipe::heights, {Heights::graded}) or in_equilibrium,
        "concavity theta of graded rivers and of equilibrium terrain: slope ~ area^-theta",
        [](Recipe& r, Item) -> Field { return &r.network->concavity; }, {.earlier = {0.45}}),
    key("network.rotate", number, "degrees", {-180, 180}, from_cluster,
        "rotation of the cluster, counterclockwise; left out: random with equilibrium, else 0",
        [](Recipe& r, Item) -> Field { return &r.network->rotate_deg; }),
    key("network.meander", number, "", {0, 2}, {},
        "meander amplitude, 1 as in nature; left out: 1 for grown rivers with equilibrium, 0.3 where they end on a "
        "coast, else 0",
        [](Recipe& r, Item) -> Field { return &r.network->meander; }),
    key("network.inland", word, "", {"carry", "sink", "coast"},
        with_rivers and is(&SurfaceRecipe::method, {Method::equilibrium, Method::raster}) and
            is(&NetworkRecipe::source, {Source::dla, Source::tokunaga, Source::lines}),
        "rivers that end inside the grid: extend them to its border or the sea, keep them as sinks, or take their "
        "ends for mouths on a coast and make what lies before them the sea",
        [](Recipe& r, Item) -> Field { return choice(r.network->inland); }),
    key("network.fill_space", yes_no, "", {"true", "false"}, in_equilibrium,
        "add the side valleys of the terrain to the network as arcs",
        [](Recipe& r, Item) -> Field { return &r.network->fill_space; }),
    key("network.support", integer, "cells", {1, 1e9}, in_equilibrium and is(&NetworkRecipe::fill_space, {true}),
        "drainage area at which a side valley begins",
        [](Recipe& r, Item) -> Field { return &r.network->support_cells; }),
    key("network.rosgen", word, "", rosgen_words,
        is(&NetworkRecipe::heights, {Heights::rosgen}) or above(&NetworkRecipe::coast_m, 0),
        "Rosgen type of rivers without one: by Strahler order, or one type for all",
        [](Recipe& r, Item) -> Field { return choice(r.network->rosgen); }),
    key("network.rosgen_slope", word, "", {"middle", "uniform"}, is(&NetworkRecipe::heights, {Heights::rosgen}),
        "slope of a river within its type's range: the usual value, or a random one",
        [](Recipe& r, Item) -> Field { return choice(r.network->rosgen_slope); }),
    key("network.coast", number, "m", {0, 1e9}, {},
        "rivers closer to their outlet than this, along the stream, are marked as braided",
        [](Recipe& r, Item) -> Field { return &r.network->coast_m; }),
    key("network.dla.particles", integer, "", {1, 1e9}, from_cluster, "number of particles in the cluster",
        [](Recipe& r, Item) -> Field { return &r.network->dla.particles; }),
    key("network.dla.radius", integer, "cells", {0, 1e6}, from_cluster,
        "radius of the cluster at which growth stops early; 0: none",
        [](Recipe& r, Item) -> Field { return &r.network->dla.max_radius; }),
    key("network.dla.sticking", number, "", {0, 1, left_open}, from_cluster,
        "sticking probability S: a particle with n occupied neighbours sticks with S^(3-n)",
        [](Recipe& r, Item) -> Field { return &r.network->dla.sticking; }),
    key("network.dla.visits", integer, "", {1, 255}, from_cluster,
        "noise-reduction count M: arrivals that a site needs before it is occupied",
        [](Recipe& r, Item) -> Field { return &r.network->dla.visits; }),
    key("network.dla.rule", word, "", {"count_first", "stick_then_count"},
        from_cluster and above(&growth::DlaParams::visits, 1) and below(&growth::DlaParams::sticking, 1),
        "whether an arrival counts before or after its sticking test",
        [](Recipe& r, Item) -> Field { return choice(r.network->dla.rule); }),
    key("network.dla.branch", word, "", {"largest", "north", "east", "south", "west", "all"}, from_cluster,
        "which arm of the cluster becomes the valley",
        [](Recipe& r, Item) -> Field { return choice(r.network->branch); }),
    key("network.tokunaga.generator", integer, "", {1, 50}, by_tokunaga,
        "lambda of the tree, and of strokes without their own: 1 has no side branches, 2 is dendritic, larger "
        "values are feathered",
        [](Recipe& r, Item) -> Field { return &r.network->tokunaga.generator; }),
    key("network.tokunaga.order", integer, "", {1, 12}, by_tokunaga,
        "Strahler order at the outlet; with strokes, that of one as long as the grid is wide",
        [](Recipe& r, Item) -> Field { return &r.network->tokunaga.order; }),
    key("network.tokunaga.rule", word, "", {"tokunaga", "constant", "plane"},
        by_tokunaga and not given(&TokunagaRecipe::strokes),
        "number of side branches of a link: by its order, constant as published, or such that the fractal "
        "dimension is 2",
        [](Recipe& r, Item) -> Field { return choice(r.network->tokunaga.rule); }),
    key("network.tokunaga.mouth", word, "", {"north", "east", "south", "west"},
        by_tokunaga and not given(&TokunagaRecipe::strokes), "side of the grid or region where the river leaves",
        [](Recipe& r, Item) -> Field { return choice(r.network->tokunaga.mouth); }),
    key("network.tokunaga.region", file, "", {}, by_tokunaga, "polygon that the network fills; \"\": the grid",
        [](Recipe& r, Item) -> Field { return &r.network->tokunaga.region; }),
    key("network.tokunaga.strokes", file, "", {}, by_tokunaga,
        "lines drawn from outlet to source, each of which grows a network; \"\": one network in the region",
        [](Recipe& r, Item) -> Field { return &r.network->tokunaga.strokes; }),
    key("network.tokunaga.layer", text, "", "name", from_strokes, "layer of the strokes; \"\": the only line layer",
        [](Recipe& r, Item) -> Field { return &r.network->tokunaga.layer; }),
    key("network.tokunaga.spacing", number, "cells", {0, 1e6}, by_tokunaga,
        "minimum distance between links; closer ones are left out",
        [](Recipe& r, Item) -> Field { return &r.network->tokunaga.spacing_cells; }),
    key("network.forest.shape", word, "", {"grid", "island"}, from_forest and not given(&ForestRecipe::region),
        "extent of the land where no region is given: the whole grid, or an island in it",
        [](Recipe& r, Item) -> Field { return choice(r.network->forest.shape); }),
    key("network.forest.ruggedness", number, "", {0, 1},
        from_forest and not given(&ForestRecipe::region) and is(&ForestRecipe::shape, {LandShape::island}),
        "how far fjords and capes of the island reach",
        [](Recipe& r, Item) -> Field { return &r.network->forest.ruggedness; }),
    key("network.forest.region", file, "", {}, from_forest,
        "polygons that are land, with sea around them; \"\": see shape",
        [](Recipe& r, Item) -> Field { return &r.network->forest.region; }),
    key("network.forest.outlets", file, "", {}, from_forest,
        "where rivers reach the coast: points, lines along the coast, or polygons of water; \"\": anywhere on the "
        "coast",
        [](Recipe& r, Item) -> Field { return &r.network->forest.outlets; }),
    key("network.forest.seeds", integer, "", {0, 1e6}, from_forest,
        "number of outlets at random places on the coast; 0: see outlet_spacing",
        [](Recipe& r, Item) -> Field { return &r.network->forest.seeds; }),
    key("network.forest.outlet_spacing", integer, "cells", {0, 1e6}, from_forest and is(&ForestRecipe::seeds, {0}),
        "coast, or border of the grid, for each outlet; 0: six spacings of rivers",
        [](Recipe& r, Item) -> Field { return &r.network->forest.outlet_spacing_cells; }),
    key("network.forest.spacing", integer, "cells", {8, 200}, from_forest,
        "minimum distance between rivers that do not meet",
        [](Recipe& r, Item) -> Field { return &r.network->forest.spacing_cells; }),
    key("network.forest.particles", integer, "", {0, 1e9}, from_forest,
        "number of particles of all trees; 0: until the land is full",
        [](Recipe& r, Item) -> Field { return &r.network->forest.growth.particles; }),
    key("network.forest.sticking", number, "", {0, 1, left_open}, from_forest, "sticking probability",
        [](Recipe& r, Item) -> Field { return &r.network->forest.growth.sticking; }),
    key("network.forest.visits", integer, "", {1, 255}, from_forest,
        "noise-reduction count M: arrivals that a cell needs before it is occupied; larger values make straighter "
        "rivers",
        [](Recipe& r, Item) -> Field { return &r.network->forest.growth.visits; }),
    key("network.lines.path", file, "", {}, from_lines, "file of lines: GeoPackage, Shapefile, GeoJSON, ...",
        [](Recipe& r, Item) -> Field { return &r.network->lines.path; },
        {.layer = "network.lines.layer", .folder = ""}),
    key("network.lines.layer", text, "", "name", from_lines,
        "layer of the lines, or several, separated by commas; \"\": the only line layer, the one whose name says "
        "that "
        "it holds rivers, or all of KML and GPX",
        [](Recipe& r, Item) -> Field { return &r.network->lines.layer; }),
    key("network.lines.source_crs", text, "", "EPSG code or WKT", from_lines,
        "coordinate system of a line file that has none; \"\": such a file is refused",
        [](Recipe& r, Item) -> Field { return &r.network->lines.source_crs; }),
    key("network.lines.type_field", text, "", "name", from_lines,
        "field with the river type; the field rosgen may be missing",
        [](Recipe& r, Item) -> Field { return &r.network->lines.type_field; }),
    key("network.lines.rank_field", text, "", "name",
        from_lines and
            (is(&LinesRecipe::orientation, {network::Orientation::automatic, network::Orientation::rank}) or
             (is(&LinesRecipe::orientation, {network::Orientation::height, network::Orientation::as_drawn}) and
              is(&LinesRecipe::divergences, {network::Divergences::main}))),
        "field of numbers that decrease downstream, and are least on the main of several branches; \"\": a known "
        "one (docs/river_files.md)",
        [](Recipe& r, Item) -> Field { return &r.network->lines.rank_field; }),
    key("network.lines.id_field", text, "", "name", by_links,
        "field with the id of a line, for down_field; \"\": a known one (docs/river_files.md)",
        [](Recipe& r, Item) -> Field { return &r.network->lines.id_field; }),
    key("network.lines.down_field", text, "", "name", by_links,
        "field with the id of the line downstream; \"\": a known one (docs/river_files.md)",
        [](Recipe& r, Item) -> Field { return &r.network->lines.down_field; }),
    key("network.lines.from_field", text, "", "name", by_links,
        "field with the node from which a line's water comes, for to_field; \"\": a known one "
        "(docs/river_files.md)",
        [](Recipe& r, Item) -> Field { return &r.network->lines.from_field; }),
    key("network.lines.to_field", text, "", "name", by_links,
        "field with the node to which a line's water goes; \"\": a known one (docs/river_files.md)",
        [](Recipe& r, Item) -> Field { return &r.network->lines.to_field; }),
    key("network.lines.direction_field", text, "", "name", by_links,
        "field that says whether water runs as a line is drawn, in words of a known data set; \"\": a known one "
        "(docs/river_files.md)",
        [](Recipe& r, Item) -> Field { return &r.network->lines.direction_field; }),
    key("network.lines.where", text, "", "SQL condition", from_lines,
        "condition on fields, as after WHERE: other lines are not read; \"\": all lines",
        [](Recipe& r, Item) -> Field { return &r.network->lines.where; }),
    key("network.lines.snap", number, "m", {0, 1e6}, from_lines,
        "line ends closer than this are joined; 0: open ends within half a cell, or two where it is clear to what "
        "(docs/rivers_you_have.md)",
        [](Recipe& r, Item) -> Field { return &r.network->lines.snap_m; }),
    key("network.lines.orientation", word, "",
        {{"auto", network::Orientation::automatic},
         {"height", network::Orientation::height},
         {"rank", network::Orientation::rank},
         {"as_drawn", network::Orientation::as_drawn},
         {"topology", network::Orientation::topology}},
        from_lines,
        "what decides the flow direction of a line; auto: links, a direction column, Z or ranks, and else angles "
        "at confluences, the border, the drawn direction and network.lines.dem together",
        [](Recipe& r, Item) -> Field { return choice(r.network->lines.orientation); }),
    key("network.lines.dem", file, "", {},
        from_lines and is(&LinesRecipe::orientation, {network::Orientation::automatic}),
        "DEM of the land that the lines are of, in any CRS, for the flow direction of lines: together with angles "
        "at confluences, where fields and Z do not tell it",
        [](Recipe& r, Item) -> Field { return &r.network->lines.dem; }),
    key("network.lines.divergences", word, "", {"main", "error"}, from_lines,
        "where water could go more than one way: keep the main path and report the other branches as secondary, or "
        "refuse the file",
        [](Recipe& r, Item) -> Field { return choice(r.network->lines.divergences); }),
    key("network.lines.filter", word, "", {"natural", "none"}, from_lines,
        "natural leaves out canals, ditches, pipes, weirs and coastlines, as the fields of OSM and NHD name them; "
        "none keeps all lines",
        [](Recipe& r, Item) -> Field { return choice(r.network->lines.filter); }),
    key("network.lines.coastlines", word, "", {"sea", "none"},
        from_lines and is(&LinesRecipe::filter, {io::LineFilter::natural}),
        "coastlines among the lines: sea, beyond them is the sea, where rivers end; none, they mean nothing",
        [](Recipe& r, Item) -> Field { return choice(r.network->lines.coastlines); }),
    key("network.lines.keep", number, "", {0, 1}, from_lines,
        "least share of the given length that must be in the network (check given_length): without what filter, "
        "coastlines, divergences, duplicates, the grid and network.prune leave out",
        [](Recipe& r, Item) -> Field { return &r.network->lines.keep; }),
    key("skeleton.ridges", word, "", {"none", "voronoi", "segments"}, beside_rivers,
        "ridges midway between streams: edges of the Voronoi diagram of points along them, or exact medial lines",
        [](Recipe& r, Item) -> Field { return choice(r.skeleton->ridges); }),
    key("skeleton.ridge_gain", number, "m/m", {0, 100}, above_rivers,
        "lambda_h: rise of a ridge above its rivers per metre of distance, and greatest rise of a random point",
        [](Recipe& r, Item) -> Field { return &r.skeleton->ridge_gain; }),
    key("skeleton.ridge_farthest", number, "m", {0, 1e7}, above_rivers and above(&SkeletonRecipe::ridge_gain, 0),
        "d_max: distance from the rivers beyond which ridges and random points rise no more; 0: none",
        [](Recipe& r, Item) -> Field { return &r.skeleton->ridge_farthest_m; }),
    key("skeleton.ridge_noise", number, "m", {0, 1e5}, with_noise, "amplitude of noise along ridges, 0 at their ends",
        [](Recipe& r, Item) -> Field { return &r.skeleton->ridge_noise_m; }),
    key("skeleton.ridge_wavelength", number, "m", {0, 1e7, left_open},
        with_noise and above(&SkeletonRecipe::ridge_noise_m, 0), "longest wavelength of that noise",
        [](Recipe& r, Item) -> Field { return &r.skeleton->ridge_wavelength_m; }),
    key("skeleton.midpoint_inverse", number, "cells", {0, 1e6},
        with_rivers and is(&SurfaceRecipe::method, {Method::diffuse}),
        "L: heights of cells up to this far from rivers, ridges and points by inverse midpoint displacement; 0: "
        "none",
        [](Recipe& r, Item) -> Field { return &r.skeleton->midpoint_inverse_cells; }),
    key("skeleton.points", file, "", {}, (from_points or through_features) and is(&SkeletonRecipe::scatter, {0}),
        "points with heights: CSV, XYZ, LAS, or a file of points (GeoPackage, ...)",
        [](Recipe& r, Item) -> Field { return &r.skeleton->points; }),
    key("skeleton.height_column", text, "", "name",
        (from_points or through_features) and given(&SkeletonRecipe::points),
        "column of the points' heights; \"\": Z, or a column z",
        [](Recipe& r, Item) -> Field { return &r.skeleton->height_column; }),
    key("skeleton.nodata", number, "", {-1e38, 1e38},
        (from_points or through_features) and given(&SkeletonRecipe::points),
        "height of points that stands for no data, left out; left out: -9999 and the like are refused",
        [](Recipe& r, Item) -> Field { return &r.skeleton->nodata; }),
    key("skeleton.ridge_lines", file, "", {}, through_features,
        "lines that are ridges, with or without Z (GeoPackage, Shapefile, ...): no water crosses them, and the "
        "terrain has their heights",
        [](Recipe& r, Item) -> Field { return &r.skeleton->ridge_lines; }),
    key("skeleton.ridge_height_column", text, "", "name", through_features and given(&SkeletonRecipe::ridge_lines),
        "column of the height of all of a ridge; \"\": Z of its vertices",
        [](Recipe& r, Item) -> Field { return &r.skeleton->ridge_height_column; }),
    key("skeleton.scatter", integer, "", {0, 1e7},
        (from_points or beside_rivers) and not given(&SkeletonRecipe::points),
        "number of random points, between the rivers or, without [network], including the extremes of [statistics]",
        [](Recipe& r, Item) -> Field { return &r.skeleton->scatter; }),
    key("skeleton.spacing", number, "cells", {0, 1e5},
        (from_points or beside_rivers) and above(&SkeletonRecipe::scatter, 0),
        "minimum distance r between random points, and from them to rivers",
        [](Recipe& r, Item) -> Field { return &r.skeleton->spacing_cells; }),
    key("skeleton.law", word, "", {"uniform", "normal"},
        (from_points or beside_rivers) and above(&SkeletonRecipe::scatter, 0),
        "distribution of the heights of random points; with [network], of their share of ridge_gain times the "
        "distance from the nearest river",
        [](Recipe& r, Item) -> Field { return choice(r.skeleton->law); }),
    key("skeleton.deviation", word, "", {"exact", "printed"}, from_points and above(&SkeletonRecipe::scatter, 0),
        "deviation of random points: exactly statistics.std, or by equation 8 of Zhang, Liu and Li, heights "
        "uniform within statistics.std of the mean",
        [](Recipe& r, Item) -> Field { return choice(r.skeleton->deviation); }),
    key("skeleton.falloff", word, "",
        {{"literal", skeleton::Falloff::literal}, {"continuous", skeleton::Falloff::continuous}},
        from_points and above(&SkeletonRecipe::scatter, 0) and above(&StatisticsRecipe::reach_cells, 0) and
            with_extremes,
        "pull of random points towards max and min at distance R: with a step as published, or continuous to 0",
        [](Recipe& r, Item) -> Field { return choice(r.skeleton->falloff); }),
    key("skeleton.tin", yes_no, "", {"true", "false"},
        around_rivers or (from_points and (not has(&Recipe::surface) or is(&SurfaceRecipe::method, {Method::tin}))),
        "write the TIN of rivers and points: tin.2dm, tin.ply",
        [](Recipe& r, Item) -> Field { return &r.skeleton->tin; }),
    key("surface.method", word, "", {"equilibrium", "dilate", "diffuse", "tin", "regress", "raster"},
        with_rivers or given(&SurfaceRecipe::source) or from_points,
        "how the terrain is made: by landscape evolution around the rivers, by dilation from the valleys, by "
        "diffusion between rivers, ridges and points, over a TIN, by regression through points, or as a DEM has it",
        [](Recipe& r, Item) -> Field { return choice(r.surface->method); }),
    key("surface.source", file, "", {}, on_raster,
        "DEM that is the terrain; resampled only where [grid] asks for other cells or another coordinate system, "
        "or where its own is not in metres",
        [](Recipe& r, Item) -> Field { return &r.surface->source; }),
    key("surface.base", word, "", {"harmonic", "paper", "tin"}, by_dilation,
        "heights that slopes rise from: a harmonic surface through the rivers, the nearest valley cell as "
        "published, or the TIN of the rivers",
        [](Recipe& r, Item) -> Field { return choice(r.surface->base); }),
    key("surface.increment", text, "", {surface::increment_names, "an expression in x", is_increment}, by_dilation,
        "height increment dh of the x-th dilation",
        [](Recipe& r, Item) -> Field { return &r.surface->dilate.increment.increment; }),
    key("surface.metric", word, "", {"cityblock", "euclid"}, by_dilation,
        "distance to the valley: over 4 neighbours as published, or Euclidean",
        [](Recipe& r, Item) -> Field { return choice(r.surface->dilate.metric); }),
    key("surface.relief", number, "m", {0, 1e5},
        with_rivers and is(&SurfaceRecipe::method, {Method::equilibrium, Method::dilate}),
        "equilibrium: height from the lowest to the highest cell, 0: see mean_slope; dilate: greatest sum of the "
        "increments, 0: published units times the cell size",
        [](Recipe& r, Item) -> Field { return &r.surface->dilate.relief_m; }),
    key("surface.allow_negative", yes_no, "", {"true", "false"}, by_dilation, "keep increments below 0",
        [](Recipe& r, Item) -> Field { return &r.surface->dilate.increment.allow_negative; }),
    key("surface.mask", file, "", {},
        with_rivers or given(&SurfaceRecipe::source) or (from_points and not has(&Recipe::statistics)),
        "polygons: cells whose middle lies in none of them get no height; or a raster on the grid: cells with 0 or "
        "no data get none",
        [](Recipe& r, Item) -> Field { return &r.surface->mask; }),
    key("surface.mean_slope", number, "degrees", {0, 60, left_open},
        in_equilibrium and is(&surface::DilateParams::relief_m, {0}),
        "mean slope of the terrain; left out: 25, around rivers of a file less on cells above 30 m",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.mean_slope_deg; }, {.earlier = {25.0}}),
    key("surface.steepness", number, "m^0.9", {0, 1000, left_open},
        in_equilibrium and is(&surface::DilateParams::relief_m, {0}),
        "greatest normalised steepness of the rivers' main stems, for a concavity of 0.45, to which the terrain is "
        "lowered where mean_slope makes them steeper; left out: 45 around rivers of a file that has no heights, where "
        "neither mean_slope nor like is set, else not bounded",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.steepness; }, {.earlier = {45.0}}),
    key("surface.hillslope", number, "m", {0, 1e5}, in_equilibrium,
        "length below which soil creep rounds the slopes; 0: one cell",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.hillslope_m; }, {.earlier = {0.0}}),
    key("surface.debris_area", number, "km2", {0, 1e6}, in_equilibrium,
        "drainage area below which debris flows cut hillsides, whose slopes hardly depend on area",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.debris_area_km2; }),
    key("surface.floor_width", number, "", {0, 1}, in_equilibrium,
        "width of valley floors: 0.04 is 17 m where 1 km2 drains, in proportion; it grows with drainage area ^ "
        "0.42, up to 200 km2",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.floor_width; }, {.earlier = {0.0425}}),
    key("surface.roughness", number, "", {0, 1}, in_equilibrium, "standard deviation of the logarithm of erodibility",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.roughness; }, {.earlier = {0.4, 0.25}}),
    key("surface.longest_wave", number, "m", {0, 1e7, left_open}, by_rough_rock, "longest wavelength of that variation",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.longest_wave_m; }),
    key("surface.grain", number, "", {1, 20}, by_rough_rock,
        "how many times as far rock of one kind reaches along its strike as across it; 1: no grain",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.grain; }),
    key("surface.strike", number, "degrees", {-360, 360},
        (by_rough_rock and above(&EquilibriumRecipe::grain, 1)) or
            (in_equilibrium and
             is(&EquilibriumRecipe::uplift_pattern, {surface::UpliftPattern::tilt, surface::UpliftPattern::blocks,
                                                     surface::UpliftPattern::folds, surface::UpliftPattern::seed})),
        "direction of the rock's grain, of faults and folds, clockwise from north; left out: by the seed",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.strike_deg; }),
    key("surface.edge", word, "", {"auto", "open", "closed", "coast", "mainland"}, in_equilibrium,
        "boundary condition: the terrain continues (open), all water goes to the rivers (closed), sea (coast), or "
        "sea where the mask or coastlines say so and beyond the grid the terrain continues (mainland); auto: "
        "mainland with coastlines of a river file, coast with other sea, else open",
        [](Recipe& r, Item) -> Field { return choice(r.surface->equilibrium.edge); }),
    key("surface.region", number, "", {1, 5},
        in_equilibrium and is(&EquilibriumRecipe::edge, {std::nullopt, surface::Edge::open}),
        "with an open edge the large valleys are found on land wider than the grid by this factor, and rivers may "
        "enter it, unless they come from a file; 1: on the grid alone; left out: 3",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.region; }),
    key("surface.uplift", file, "", {}, in_equilibrium, "raster over the grid, values above 0; only ratios count",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.uplift; }),
    key("surface.uplift_pattern", word, "", {"none", "tilt", "domes", "blocks", "folds", "seed"}, in_equilibrium,
        "how uplift varies over long distances, beside the raster: it grows across the strike (tilt), in domes, in "
        "blocks between faults or in folds along the strike; seed: domes, blocks or folds, by the seed",
        [](Recipe& r, Item) -> Field { return choice(r.surface->equilibrium.uplift_pattern); }),
    key("surface.uplift_contrast", number, "", {1, 100},
        in_equilibrium and is(&EquilibriumRecipe::uplift_pattern,
                              {surface::UpliftPattern::tilt, surface::UpliftPattern::domes,
                               surface::UpliftPattern::blocks, surface::UpliftPattern::folds,
                               surface::UpliftPattern::seed}),
        "greatest uplift of the pattern over the least",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.uplift_contrast; }),
    key("surface.uplift_wave", number, "m", {0, 1e7, left_open},
        in_equilibrium and is(&EquilibriumRecipe::uplift_pattern,
                              {surface::UpliftPattern::domes, surface::UpliftPattern::blocks,
                               surface::UpliftPattern::folds, surface::UpliftPattern::seed}),
        "distance of domes, width of blocks, wavelength of folds",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.uplift_wave_m; }),
    key("surface.erodibility", file, "", {}, in_equilibrium,
        "raster over the grid, values above 0, or polygons with a field erodibility (1 elsewhere); only ratios "
        "count",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.erodibility; }),
    key("surface.lakes", file, "", {}, in_equilibrium or (with_rivers and on_raster),
        "polygons of lakes; a numeric field level [m] gives a lake's height, without a value it follows from the "
        "terrain at its outlet",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.lakes; }),
    key("surface.lake_share", number, "", {0, 1}, in_equilibrium,
        "share of the reaches with enough water that run through a lake",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.lake_share; }),
    key("surface.like", file, "", {}, in_equilibrium,
        "DEM of any place whose mean slope and texture, at the grid's cell size, the terrain gets; mean_slope, "
        "relief and a roughness other than its default come before it",
        [](Recipe& r, Item) -> Field { return &r.surface->equilibrium.like; }),
    key("surface.drain", word, "",
        {{"auto", std::nullopt},
         {"carve", flow::Conditioning::carve},
         {"fill", flow::Conditioning::fill},
         {"none", flow::Conditioning::none}},
        {},
        "hydrological conditioning: confine channels, then breach or fill depressions; auto: carve where there are "
        "rivers, else none",
        [](Recipe& r, Item) -> Field { return choice(r.surface->drain); }),
    key("surface.max_cut", number, "m", {0, 1e4}, with_rivers and on_raster,
        "a warning tells where a river is cut deeper into the DEM than this",
        [](Recipe& r, Item) -> Field { return &r.surface->max_cut_m; }),
    key("surface.tolerance", number, "", {1e-12, 0.1},
        (by_dilation and is(&SurfaceRecipe::base, {Base::harmonic})) or
            (by_diffusion and is(&surface::DiffuseParams::mode, {surface::Diffusion::steady})),
        "relative residual at which the harmonic base or the steady state is solved; left out: 1e-8, or 1e-10 of "
        "the steady state",
        [](Recipe& r, Item) -> Field { return &r.surface->tolerance; }),
    key("surface.diffusion", word, "", {"steady", "explicit"}, by_diffusion,
        "steady state, or a number of explicit sweeps as published",
        [](Recipe& r, Item) -> Field { return choice(r.surface->diffuse.mode); }),
    key("surface.sweeps", integer, "", {0, 1e9},
        by_diffusion and is(&surface::DiffuseParams::mode, {surface::Diffusion::explicit_sweeps}),
        "number of explicit sweeps", [](Recipe& r, Item) -> Field { return &r.surface->diffuse.iterations; }),
    key("surface.start", word, "", {"coarse", "zero"},
        by_diffusion and is(&surface::DiffuseParams::mode, {surface::Diffusion::explicit_sweeps}),
        "where sweeps start: from the steady state of a coarser grid, or from 0 as published",
        [](Recipe& r, Item) -> Field { return choice(r.surface->diffuse.start); }),
    key("surface.alpha", number, "", {0, 0.25, left_open},
        by_diffusion and is(&surface::DiffuseParams::mode, {surface::Diffusion::explicit_sweeps}),
        "D dt / h^2 of an explicit sweep", [](Recipe& r, Item) -> Field { return &r.surface->diffuse.alpha; }),
    key("surface.smoothing", number, "cells", {0, 100}, by_diffusion,
        "sigma of Gaussian smoothing away from rivers, ridges and points; 0: none",
        [](Recipe& r, Item) -> Field { return &r.surface->diffuse.sigma_cells; }),
    key("surface.noise", number, "m", {0, 1e5}, by_diffusion, "amplitude of noise far from rivers, ridges and points",
        [](Recipe& r, Item) -> Field { return &r.surface->diffuse.noise_m; }),
    key("surface.interpolation", word, "", {"linear", "natural"},
        from_points and is(&SurfaceRecipe::method, {Method::tin}), "linear in triangles, or natural neighbours",
        [](Recipe& r, Item) -> Field { return choice(r.surface->interpolation); }),
    key("surface.frequency_x", number, "cycles", {0, 1e4},
        from_points and is(&SurfaceRecipe::method, {Method::regress}),
        "f_x over the grid's width; 0 leaves its term out",
        [](Recipe& r, Item) -> Field { return &r.surface->regress.frequency_x; }),
    key("surface.frequency_y", number, "cycles", {0, 1e4},
        from_points and is(&SurfaceRecipe::method, {Method::regress}),
        "f_y over the grid's height; 0 leaves its term out",
        [](Recipe& r, Item) -> Field { return &r.surface->regress.frequency_y; }),
    key("surface.slope_mode", word, "", {"none", "centre", "mean"},
        from_points and is(&SurfaceRecipe::method, {Method::regress}),
        "what statistics.slope constrains: nothing, the slope at the grid's centre, or the mean square slope",
        [](Recipe& r, Item) -> Field { return choice(r.surface->regress.slope); }),
    key("surface.eighth_term", word, "", {"x2y2", "x3y"}, from_points and is(&SurfaceRecipe::method, {Method::regress}),
        "the eighth term, whose exponents are illegible in Zhang, Liu and Li",
        [](Recipe& r, Item) -> Field { return choice(r.surface->regress.eighth); }),
    key("strata.repeat", yes_no, "", {"true", "false"}, in_layers,
        "the layers lie above and below each other again and again; else the lowest and the topmost have no end",
        [](Recipe& r, Item) -> Field { return &r.strata->repeat; }),
    key("strata.base", number, "m", {-1e5, 1e5}, in_layers,
        "bottom of the lowest layer at the middle of the grid, above the lowest end of a river; folds, domes and "
        "faults "
        "move it",
        [](Recipe& r, Item) -> Field { return &r.strata->base_m; }),
    key("strata.cap_share", number, "", {0, 1, left_open}, in_layers and ask::is(&StrataRecipe::repeat, {false}),
        "share of the land that reaches the cap rock, the topmost layer that is firmer than the one upon it: so high "
        "is "
        "the land, in place of surface.relief; left out: not asked",
        [](Recipe& r, Item) -> Field { return &r.strata->cap_share; }),
    key("strata.dip", number, "degrees", {0, 75}, in_layers, "by which layers are tilted",
        [](Recipe& r, Item) -> Field { return &r.strata->dip_deg; }),
    key("strata.strike", number, "degrees", {-360, 360}, in_layers,
        "direction of level lines on a layer, clockwise from north: it dips to the right of it; left out: "
        "surface.strike",
        [](Recipe& r, Item) -> Field { return &r.strata->strike_deg; }),
    key("strata.fold", number, "m", {0, 1e5}, in_layers, "amplitude of folds, half the height from trough to crest",
        [](Recipe& r, Item) -> Field { return &r.strata->fold_m; }),
    key("strata.fold_wave", number, "m", {0, 1e7, left_open}, folded, "distance of their crests",
        [](Recipe& r, Item) -> Field { return &r.strata->fold_wave_m; }),
    key("strata.fold_axis", number, "degrees", {-360, 360}, folded,
        "direction of their crests, clockwise from north; left out: strata.strike. Folds of rock are not those of "
        "surface.uplift_pattern",
        [](Recipe& r, Item) -> Field { return &r.strata->fold_axis_deg; }),
    key("strata.plunge", number, "degrees", {-30, 30}, folded, "by which crests fall along that direction",
        [](Recipe& r, Item) -> Field { return &r.strata->plunge_deg; }),
    key("strata.dome", number, "m", {-1e5, 1e5}, in_layers, "rise of layers towards a place; below 0: a basin",
        [](Recipe& r, Item) -> Field { return &r.strata->dome_m; }),
    key("strata.dome_radius", number, "m", {0, 1e7, left_open}, domed, "distance where 0.61 of it is left",
        [](Recipe& r, Item) -> Field { return &r.strata->dome_radius_m; }),
    key("strata.dome_at", pair, "m", {"[x, y] within 1e9", is_near}, domed,
        "its middle; left out: the middle of the grid", [](Recipe& r, Item) -> Field { return &r.strata->dome_at; }),
    key("strata.fault", number, "m", {-1e5, 1e5}, in_layers,
        "throw of a vertical fault: layers lie lower by it to the right of the way along the fault",
        [](Recipe& r, Item) -> Field { return &r.strata->fault_m; }),
    key("strata.fault_strike", number, "degrees", {-360, 360}, faulted,
        "direction of the fault, clockwise from north; left out: strata.strike",
        [](Recipe& r, Item) -> Field { return &r.strata->fault_strike_deg; }),
    key("strata.fault_at", pair, "m", {"[x, y] within 1e9", is_near}, faulted,
        "a point of it; left out: the middle of the grid",
        [](Recipe& r, Item) -> Field { return &r.strata->fault_at; }),
    key("strata.undulation", number, "m", {0, 1e5}, in_layers, "amplitude of random bends of all layers",
        [](Recipe& r, Item) -> Field { return &r.strata->undulation_m; }),
    key("strata.undulation_wave", number, "m", {0, 1e7, left_open}, in_layers and above(&StrataRecipe::undulation_m, 0),
        "their wavelength", [](Recipe& r, Item) -> Field { return &r.strata->undulation_wave_m; }),
    key("layer.thickness", number, "m", {0, 1e5, left_open}, in_equilibrium,
        "across the layer; the first [[layer]] is the lowest",
        [](Recipe& r, Item i) -> Field { return &r.layers[i].thickness_m; }),
    key("layer.strength", number, "", {0.001, 1000}, in_equilibrium,
        "how many times as steep as in rock without layers slopes are in it: soft rock 0.1 to 0.5, a cap rock 6 to "
        "12, bare land above one 0.03 to 0.08",
        [](Recipe& r, Item i) -> Field { return &r.layers[i].strength; }),
    key("layer.cliff", number, "", {0.01, 20}, in_equilibrium,
        "tangent of its steepest slopes: soft rock 0.3 to 0.55, cliffs 4 to 6",
        [](Recipe& r, Item i) -> Field { return &r.layers[i].cliff; }),
    key("statistics.mean", number, "m", {-1e6, 1e6}, not with_rivers, "mean height",
        [](Recipe& r, Item) -> Field { return &r.statistics->mean; }),
    key("statistics.std", number, "m", {0, 1e6, left_open}, not with_rivers, "standard deviation of heights",
        [](Recipe& r, Item) -> Field { return &r.statistics->std; }),
    key("statistics.max", triple, "m", {place_words, is_place}, not with_rivers, "highest cell",
        [](Recipe& r, Item) -> Field { return &r.statistics->max; }),
    key("statistics.min", triple, "m", {place_words, is_place}, not with_rivers, "lowest cell",
        [](Recipe& r, Item) -> Field { return &r.statistics->min; }),
    key("statistics.length", pair, "cells", {"[Lx, Ly] above 0", are_lengths}, not with_rivers,
        "correlation lengths: where the autocorrelation falls to 1/e",
        [](Recipe& r, Item) -> Field { return &r.statistics->length; }),
    key("statistics.slope", number, "rad", {0, 1.5707, left_open}, not with_rivers,
        "mean arctan of the slope, in metres per cell", [](Recipe& r, Item) -> Field { return &r.statistics->slope; }),
    key("statistics.dimension", number, "", {2.01, 2.99}, not with_rivers, "fractal dimension",
        [](Recipe& r, Item) -> Field { return &r.statistics->dimension; }),
    key("statistics.skeleton", word, "", {"grf", "separable", "markov3", "points"}, not with_rivers,
        "terrain that is matched to the statistics: a random field, or that of the points of [skeleton]",
        [](Recipe& r, Item) -> Field { return choice(r.statistics->skeleton); }),
    key("statistics.reach", number, "cells", {0, 1e5},
        not with_rivers and
            (is(&StatisticsRecipe::skeleton, {Prior::separable, Prior::markov3}) or
             above(&SkeletonRecipe::scatter, 0)) and
            with_extremes,
        "R: distance within which heights are pulled towards max and min",
        [](Recipe& r, Item) -> Field { return &r.statistics->reach_cells; }),
    key("statistics.falloff", word, "", {"continuous", "literal"},
        not with_rivers and is(&StatisticsRecipe::skeleton, {Prior::separable, Prior::markov3}) and with_extremes,
        "pull at distance R: continuous to 0, or with a step as published",
        [](Recipe& r, Item) -> Field { return choice(r.statistics->falloff); }),
    key("detail.method", word, "", {{"midpoint", DetailMethod::midpoint}, {"none", DetailMethod::none}}, with_surface,
        "fractal detail between every 2^levels-th cell",
        [](Recipe& r, Item) -> Field { return choice(r.detail->method); }),
    key("detail.levels", integer, "", {1, 12}, with_surface and is(&DetailRecipe::method, {DetailMethod::midpoint}),
        "how often cells are halved", [](Recipe& r, Item) -> Field { return &r.detail->midpoint.levels; }),
    key("detail.hurst", number, "", {0.05, 0.95}, with_surface and is(&DetailRecipe::method, {DetailMethod::midpoint}),
        "Hurst exponent H = 3 - fractal dimension; left out: estimated, with rivers 0.6",
        [](Recipe& r, Item) -> Field { return &r.detail->midpoint.hurst; }),
    key("detail.sigma", number, "m", {0, 1e6}, with_surface and is(&DetailRecipe::method, {DetailMethod::midpoint}),
        "root mean square difference of heights 2^levels cells apart; left out: estimated, with rivers it must be "
        "given",
        [](Recipe& r, Item) -> Field { return &r.detail->midpoint.sigma; }),
    key("detail.stencil", integer_or_word, "",
        {{"4", fractal::Stencil::four},
         {"12", fractal::Stencil::twelve},
         {"16", fractal::Stencil::sixteen},
         {"exact", fractal::Stencil::exact}},
        with_surface and is(&DetailRecipe::method, {DetailMethod::midpoint}),
        "number of neighbours that a height is interpolated from; 4 with the published variance; exact: a "
        "fractional Brownian surface through all coarse cells, of which there are up to 2000",
        [](Recipe& r, Item) -> Field { return choice(r.detail->midpoint.stencil); }),
    key("detail.noise", word, "", {"normal", "uniform"},
        with_surface and is(&DetailRecipe::method, {DetailMethod::midpoint}) and
            is(&fractal::MidpointParams::stencil,
               {fractal::Stencil::four, fractal::Stencil::twelve, fractal::Stencil::sixteen}),
        "distribution of the displacements", [](Recipe& r, Item) -> Field { return choice(r.detail->midpoint.noise); }),
    key("detail.adaptation", word, "", {"global", "local"},
        is(&DetailRecipe::method, {DetailMethod::midpoint}) and
            is(&fractal::MidpointParams::stencil,
               {fractal::Stencil::four, fractal::Stencil::twelve, fractal::Stencil::sixteen}) and
            not with_rivers,
        "one H and sigma for the grid, or local ones where they differ",
        [](Recipe& r, Item) -> Field { return choice(r.detail->midpoint.adaptation); }),
    key("patch.source", file, "", {}, with_surface, "DEM whose relief is pasted; reprojected to the grid",
        [](Recipe& r, Item i) -> Field { return &r.patches[i].source; }, {.folder = ""}),
    key("patch.at", pair, "m", {"[x, y] within 1e9", is_near}, with_surface,
        "where its centre goes; left out: its own place, or the middle of the grid",
        [](Recipe& r, Item i) -> Field { return &r.patches[i].at; }),
    key("patch.window", quad, "cells", {"[column, row, width, height], whole, from 0 in the north-west", is_window},
        with_surface, "part of the source that is pasted; left out: all of it",
        [](Recipe& r, Item i) -> Field { return &r.patches[i].window; }),
    key("patch.mask", file, "", {}, with_surface,
        "polygons, or a raster on the grid: what is pasted; \"\": all that the source covers",
        [](Recipe& r, Item i) -> Field { return &r.patches[i].mask; }),
    key("patch.rotate", number, "degrees", {-360, 360}, with_surface, "rotation about its centre, counterclockwise",
        [](Recipe& r, Item i) -> Field { return &r.patches[i].rotate_deg; }),
    key("patch.scale", number, "", {0, 1000, left_open}, with_surface, "scale in plan",
        [](Recipe& r, Item i) -> Field { return &r.patches[i].scale; }),
    key("patch.gain", number, "", {-1000, 1000}, with_surface, "scale of its heights",
        [](Recipe& r, Item i) -> Field { return &r.patches[i].gain; }),
    key("patch.feather", number, "cells", {0, 1e5}, with_surface,
        "width of the blend from its slopes to those of the terrain, inside its edge",
        [](Recipe& r, Item i) -> Field { return &r.patches[i].feather_cells; }),
    key("patch.rivers", word, "", {"keep", "replace"}, around_rivers, "whether rivers under it keep their heights",
        [](Recipe& r, Item i) -> Field { return choice(r.patches[i].rivers); }),
    key("output.title", text, "", "text", {}, "title of the pictures and the report; \"\": names the seed",
        [](Recipe& r, Item) -> Field { return &r.output.title; }),
    key("output.units", word, "", {"m", "ft"}, {},
        "unit of heights in dem.tif, networks, contours and TINs: metres or international feet",
        [](Recipe& r, Item) -> Field { return choice(r.output.units); }),
    key("output.contour_interval", number, "", {0, 1e5}, with_surface,
        "contour interval in output.units; 0: a round number",
        [](Recipe& r, Item) -> Field { return &r.output.contour_interval; }),
    key("output.catchments", yes_no, "", {"true", "false"}, around_rivers,
        "write the catchment of each arc: catchments.gpkg",
        [](Recipe& r, Item) -> Field { return &r.output.catchments; }),
    key("output.accumulation", yes_no, "", {"true", "false"}, with_surface,
        "write contributing areas by cell: area_d8.tif, area_dinf.tif",
        [](Recipe& r, Item) -> Field { return &r.output.accumulation; }),
    key("output.uplift", yes_no, "", {"true", "false"}, in_equilibrium,
        "write relative uplift by cell, 1 where it is the same everywhere: uplift.tif",
        [](Recipe& r, Item) -> Field { return &r.output.uplift; }),
    key("output.schema", word, "", schema_names, with_rivers,
        "also write network_SCHEMA.gpkg in this schema, unless native",
        [](Recipe& r, Item) -> Field { return choice(r.output.schema); }),
    key("output.files", words, "",
        {"dem", "network", "contours", "catchments", "areas", "tin", "pictures", "page", "qgis"}, {},
        "files to write beside recipe.toml and report.json; left out: all that the recipe makes",
        [](Recipe& r, Item) -> Field { return &r.output.files; }, {.standard = "all"}),
    key("output.against", file, "", {}, around_rivers,
        "DEM that the terrain is compared with in report.json and report.html, beside simpler terrains around the "
        "same rivers; it decides nothing of the terrain",
        [](Recipe& r, Item) -> Field { return &r.output.against; })};

} // namespace table
} // namespace

std::span<Row const> recipe_rows() {
    return table::rows;
}

} // namespace thalweg::recipe
