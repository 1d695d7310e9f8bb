// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/write_network.hpp>

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include <thalweg/core/cells/cells_along.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/network/internal/network_layers.hpp>
#include <thalweg/io/network/internal/network_tables.hpp>
#include <thalweg/io/network/internal/write_graph.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::io {

namespace {

void require_lines(RidgeLines const& ridges, std::string const& what) {
    for (std::size_t i = 0; i < ridges.lines.size(); ++i) {
        if (ridges.lines[i].line.size() < 2) {
            throw BadInput(fmt::format("{}: ridge {} between streams {} and {} has fewer than two vertices", what,
                                       i + 1, ridges.lines[i].left, ridges.lines[i].right));
        }
    }
}

Table run_table(std::map<std::string, std::string> const& rows) {
    std::vector<std::pair<std::string, std::string>> const list(rows.begin(), rows.end());
    return {"run",
            Table::Shape::none,
            list.size(),
            {{"name", Column::Kind::text, 0, [=](std::size_t row) { return list[row].first; }},
             {"value", Column::Kind::text, 0, [=](std::size_t row) { return list[row].second; }}},
            {}};
}

} // namespace

void write_geopackage(NetworkTables const& tables, std::string const& path, Run const& run) {
    std::string const file = path.ends_with(".gpkg") ? path : path + ".gpkg";
    require_whole(tables, "io.write_geopackage: " + file);
    std::vector<Table> layers{arcs_table(tables), nodes_table(tables)};
    if (tables.ridges != nullptr && !tables.ridges->lines.empty()) {
        require_lines(*tables.ridges, "io.write_geopackage: " + file);
        layers.push_back(ridges_table(*tables.ridges, tables.unit));
    }
    if (tables.secondary != nullptr && !tables.secondary->empty()) {
        layers.push_back(secondary_table(*tables.secondary, tables.user));
    }
    bool const has_sources =
        tables.user != nullptr && std::ranges::any_of(tables.user->sources, [](auto const& of) { return !of.empty(); });
    if (has_sources) {
        layers.push_back(sources_table(*tables.user));
    }
    layers.push_back(run_table(tables.run));
    write_tables(layers, tables.crs, file, run);
}

std::vector<ShortenedName> shortened_names(NetworkTables const& tables, Schema schema) {
    if (tables.user == nullptr) {
        return {};
    }
    std::string const what = "io.shortened_names";
    Table const full = network_layers(tables, schema, false, what).front();
    Table const cut = network_layers(tables, schema, true, what).front();
    std::vector<ShortenedName> names;
    for (std::size_t c = 0; c < full.columns.size(); ++c) {
        if (full.columns[c].is_users && full.columns[c].name != cut.columns[c].name) {
            names.push_back({full.columns[c].name, cut.columns[c].name});
        }
    }
    return names;
}

void write_shapefiles(NetworkTables const& tables, std::string const& path, Run const& run) {
    require_whole(tables, "io.write_shapefiles: " + path);
    write_shapefile(arcs_table(tables, true), tables.crs, path + "_arcs.shp", run);
    write_shapefile(nodes_table(tables), tables.crs, path + "_nodes.shp", run);
}

namespace {

/// PATH without its ending, which follows.
std::pair<std::string, std::string> stem_and_ending(std::string const& path) {
    std::string const ending = std::filesystem::path(path).extension().string();
    return {path.substr(0, path.size() - ending.size()), ending};
}

bool is_a_file_a_layer(NetworkFormat format) {
    return format == NetworkFormat::shapefile || format == NetworkFormat::flatgeobuf ||
           format == NetworkFormat::geojson;
}

/// The file of a layer: one a layer where there are several.
std::string file_of(std::string const& path, std::string const& layer, bool several) {
    auto const [stem, ending] = stem_and_ending(path);
    return several ? fmt::format("{}_{}{}", stem, layer, ending) : path;
}

Mask mask_of(StreamNetwork const& plan, Grid const& grid) {
    Mask cells(grid);
    for (std::size_t a = 0; a < plan.arc_count(); ++a) {
        for (Cell const c : cells_along(plan.arc(a).line, grid, fmt::format("arc {}", a + 1))) {
            cells[c] = 1;
        }
    }
    return cells;
}

} // namespace

std::vector<NetworkFormatName> const& network_formats() {
    static std::vector<NetworkFormatName> const formats{
        {NetworkFormat::geopackage, "gpkg", ".gpkg"},    {NetworkFormat::shapefile, "shp", ".shp"},
        {NetworkFormat::flatgeobuf, "fgb", ".fgb"},      {NetworkFormat::geojson, "geojson", ".geojson"},
        {NetworkFormat::graphml, "graphml", ".graphml"}, {NetworkFormat::csv, "csv", ".csv"},
        {NetworkFormat::edges, "edges", ".edges"},       {NetworkFormat::mask, "tif", ".tif"}};
    return formats;
}

NetworkFormat network_format(std::string const& name, std::string const& path) {
    return format_of(network_formats(), name, path, "io.write_network");
}

std::vector<std::string> network_files(std::string const& path, WriteNetworkParams const& params) {
    std::string const name = std::filesystem::path(path).filename().string();
    if (!is_a_file_a_layer(params.format)) {
        return {name};
    }
    std::vector<std::string> files{name};
    if (params.schema == Schema::native) {
        files = {file_of(name, "arcs", true), file_of(name, "nodes", true)};
    }
    if (params.format == NetworkFormat::shapefile) {
        std::vector<std::string> const layers = files;
        for (std::string const& layer : layers) {
            for (char const* const ending : {".shx", ".dbf", ".prj", ".cpg"}) {
                files.push_back(stem_and_ending(layer).first + ending);
            }
        }
    }
    return files;
}

void write_network(NetworkTables const& tables, std::string const& path, WriteNetworkParams const& params,
                   Run const& run) {
    std::string const what = "io.write_network: " + path;
    if (params.schema == Schema::native && params.format == NetworkFormat::geopackage) {
        write_geopackage(tables, path, run);
        return;
    }
    bool const is_shapefile = params.format == NetworkFormat::shapefile;
    std::vector<Table> const layers = network_layers(tables, params.schema, is_shapefile, what);
    auto const each = [&](auto const& write) {
        for (Table const& layer : layers) {
            write(layer, tables.crs, file_of(path, layer.name, layers.size() > 1), run);
        }
    };
    switch (params.format) {
    case NetworkFormat::geopackage: write_tables(layers, tables.crs, path, run); break;
    case NetworkFormat::shapefile: each(write_shapefile); break;
    case NetworkFormat::flatgeobuf: each(write_flatgeobuf); break;
    case NetworkFormat::geojson: each(write_geojson); break;
    case NetworkFormat::graphml:
        write_graphml({layers.front(), nodes_table(tables), tables.network.plan, tables.crs}, path, run);
        break;
    case NetworkFormat::csv:
        write_edge_table({layers.front(), nodes_table(tables), tables.network.plan, tables.crs}, path, run);
        break;
    case NetworkFormat::edges:
        write_edge_list({layers.front(), nodes_table(tables), tables.network.plan, tables.crs}, path, run);
        break;
    case NetworkFormat::mask: write_mask(mask_of(tables.network.plan, params.grid), path, run); break;
    }
}

} // namespace thalweg::io
