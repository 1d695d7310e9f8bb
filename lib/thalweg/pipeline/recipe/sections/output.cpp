// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

namespace thalweg::pipeline {

namespace {

Choices<io::Schema> schema_choices() {
    Choices<io::Schema> schemas;
    for (io::SchemaTable const& table : io::all_schemas()) {
        schemas.emplace_back(table.name, table.schema);
    }
    return schemas;
}

} // namespace

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
