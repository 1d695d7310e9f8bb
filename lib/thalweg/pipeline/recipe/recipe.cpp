// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/recipe/internal/key_rows.hpp>

namespace thalweg::pipeline {
namespace {

/// Terrain around rivers that are still to be named.
Recipe recipe_around(Source source, std::int64_t width, std::int64_t height) {
    Recipe recipe;
    recipe.grid.width = width;
    recipe.grid.height = height;
    recipe.network.emplace().source = source;
    recipe.surface.emplace().equilibrium.mean_slope_deg = 25.0;
    return recipe;
}

constexpr std::int64_t usual_side = 1024; // [cells]

/// Its words are not those of its range.
void require_corner(Value const& v) {
    auto const* p = std::get_if<Pair>(&v);
    if (p == nullptr || !(std::fabs((*p)[0]) <= 1e9 && std::fabs((*p)[1]) <= 1e9)) {
        throw BadParameter(fmt::format("two numbers [west, north] within 1e9 are required, not {}", toml_text(v)));
    }
}

Choices<io::Schema> schema_choices() {
    Choices<io::Schema> schemas;
    for (io::SchemaTable const& table : io::all_schemas()) {
        schemas.emplace_back(table.name, table.schema);
    }
    return schemas;
}

} // namespace

Recipe default_recipe() {
    return default_recipe_on(usual_side, usual_side);
}

Recipe default_recipe_on(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t in_a_side = 10;
    std::int64_t const spacing = std::clamp<std::int64_t>(std::min(width, height) / in_a_side, 8, 50);
    Recipe recipe = recipe_around(Source::forest, width, height);
    recipe.network->prune_cells = static_cast<double>(2 * spacing);
    recipe.network->forest.spacing_cells = spacing;
    recipe.network->forest.outlet_spacing_cells = 16 * spacing;
    return recipe;
}

Recipe cluster_recipe() {
    Recipe recipe = recipe_around(Source::dla, usual_side, usual_side);
    NetworkRecipe& network = *recipe.network;
    network.prune_cells = 30.0;
    network.dla.particles = 100000;
    network.dla.sticking = 1.0;
    network.dla.visits = 1;
    network.branch = network::BranchChoice::south;
    return recipe;
}

std::string title_of(Recipe const& recipe) {
    return recipe.output.title.empty() ? fmt::format("thalweg, seed {}", recipe.seed) : recipe.output.title;
}

Rows<Recipe> seed_keys() {
    return {
        number("seed", &Recipe::seed)
            .range({0, endless})
            .means("random seed of the whole recipe; recorded in the network's run table and, without output.title, in "
                   "the titles"),
    };
}

Rows<GridRecipe> grid_keys() {
    return {
        number("width", &GridRecipe::width)
            .unit("cells")
            .range({1, 1e6})
            .left_out_at_zero()
            .means("number of columns; left out: the network's extent and a margin of 5 %"),
        number("height", &GridRecipe::height)
            .unit("cells")
            .range({1, 1e6})
            .left_out_at_zero()
            .means("number of rows; left out: the network's extent and a margin of 5 %"),
        number("cell", &GridRecipe::cell_m).unit("m").range({0, 1e6, left_open}).means("cell size"),
        text("crs", &GridRecipe::crs)
            .form("EPSG code or WKT; projected, in metres")
            .means("coordinate system; \"\": that of the line file or its UTM zone, else EPSG:32631"),
        numbers("origin", &GridRecipe::origin)
            .unit("m")
            .form("[west, north]", [](Pair const&) { return true; })
            .checked(require_corner)
            .standard("[500000, 5000000], or the line file's box")
            .means("north-western corner of the grid"),
        yes_no("clip", &GridRecipe::clip)
            .used(source_is("lines") || (source_is("forest") && given("network.forest.region")))
            .means("cut rivers and polygons at the grid's edge instead of refusing those that cross it"),
    };
}

Rows<OutputRecipe> output_keys() {
    return {
        text("title", &OutputRecipe::title)
            .form("text")
            .means("title of the pictures and the report; \"\": names the seed"),
        choice("units", &OutputRecipe::units)
            .one_of({{"m", HeightUnit::metre}, {"ft", HeightUnit::foot}})
            .means("unit of heights in dem.tif, networks, contours and TINs: metres or international feet"),
        number("contour_interval", &OutputRecipe::contour_interval)
            .range({0, 1e5})
            .used(has_surface())
            .means("contour interval in output.units; 0: a round number"),
        yes_no("catchments", &OutputRecipe::catchments)
            .used(with("network") && with("surface"))
            .means("write the catchment of each arc: catchments.gpkg"),
        yes_no("accumulation", &OutputRecipe::accumulation)
            .used(has_surface())
            .means("write contributing areas by cell: area_d8.tif, area_dinf.tif"),
        choice("schema", &OutputRecipe::schema)
            .one_of(schema_choices())
            .used(with("network"))
            .means("also write network_SCHEMA.gpkg in this schema, unless native"),
    };
}

} // namespace thalweg::pipeline
