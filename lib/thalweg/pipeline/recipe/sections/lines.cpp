// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

namespace thalweg::pipeline {

namespace {

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

} // namespace

Rows<LinesRecipe> lines_keys() {
    return joined<LinesRecipe>({field_keys(), adoption_keys()});
}

} // namespace thalweg::pipeline
