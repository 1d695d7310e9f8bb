// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

#include <thalweg/core/run/error.hpp>

#include <fmt/format.h>

#include <cmath>

namespace thalweg::pipeline {

namespace {

/// Its words are not those of its range.
void require_corner(Value const& v) {
    auto const* p = std::get_if<Pair>(&v);
    if (p == nullptr || !(std::fabs((*p)[0]) <= 1e9 && std::fabs((*p)[1]) <= 1e9)) {
        throw BadParameter(fmt::format("two numbers [west, north] within 1e9 are required, not {}", toml_text(v)));
    }
}

} // namespace

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

} // namespace thalweg::pipeline
