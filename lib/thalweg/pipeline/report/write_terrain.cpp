// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/diagrams.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/draw/sections.hpp>
#include <thalweg/draw/wireframe.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/io/gdal/sources.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/io/raster/dem_derivatives.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/planform/split_confluences.hpp>
#include <thalweg/pipeline/make/internal/file_values.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/recipe/recipe_files.hpp>
#include <thalweg/pipeline/report/internal/page.hpp>
#include <thalweg/pipeline/report/internal/qgis_files.hpp>
#include <thalweg/pipeline/report/landmarks.hpp>
#include <thalweg/pipeline/report/pictures.hpp>
#include <thalweg/pipeline/report/report.hpp>

namespace thalweg::pipeline {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t largest_report = 1 << 30;

std::vector<std::string> files_left_in(std::string const& folder) {
    std::string const report = folder + "/report.json";
    return fs::exists(report) ? files_of_report(io::read_text(report, largest_report)) : std::vector<std::string>{};
}

double relief_m(Made const& t) {
    if (!t.assessment.statistics) { // not yet measured
        auto const heights = height_range(t.terrain.surface->dem);
        return heights ? heights->second - heights->first : 0.0;
    }
    return t.assessment.statistics->max.z - t.assessment.statistics->min.z;
}

/// In the recipe's unit.
double contour_interval(Made const& t) {
    double const asked = t.recipe.output.contour_interval;
    return asked > 0.0 ? asked : round_interval(relief_m(t) / metres_in(t.recipe.output.units));
}

/// For pictures and the page, which are in metres.
double contour_interval_m(Made const& t) {
    return t.recipe.output.units == HeightUnit::metre ? contour_interval(t) : round_interval(relief_m(t));
}

} // namespace

PageParams page_params_of(Made const& made, std::string recipe) {
    PageParams params;
    params.recipe = std::move(recipe);
    if (made.terrain.surface) {
        params.contour_interval_m = contour_interval_m(made);
        params.sea = sea_of(made.terrain);
        params.lakes = lake_cells(made.terrain.channels);
    }
    return params;
}

namespace {

/// Writes the network in another schema, with confluences split if it limits the number of arcs at a node.
void write_in_schema(Made const& t, io::OutputFolder const& out, Run const& run) {
    io::SchemaTable const& schema = io::table_of(t.recipe.output.schema);
    network::Split split{t.terrain.rivers.network, {}};
    if (schema.most_upstream > 0) {
        split =
            network::split_confluences(t.terrain.rivers.network, {schema.most_upstream, t.terrain.grid.cell_m}, run);
    }
    std::vector<double> us_area_m2 = t.terrain.areas.us_area_m2;
    std::vector<double> ds_area_m2 = t.terrain.areas.ds_area_m2;
    add_pieces(split.pieces, us_area_m2, ds_area_m2);
    NetworkOrders const orders = network::order(split.network.planform);
    std::vector<double> const node_area_m2 = node_areas(split.network.planform, us_area_m2, ds_area_m2);
    auto const user = user_data(t, split.network.planform);
    io::NetworkTables tables{split.network, orders, us_area_m2, ds_area_m2, node_area_m2, t.terrain.grid.crs, {}};
    tables.user = user ? &*user : nullptr;
    io::write_network(tables, out.path(fmt::format("network_{}.gpkg", schema.name)), {.schema = schema.schema}, run);
}

/// Calls write(tables) with what the files of a network hold.
template <class Write> void with_tables(Made const& t, Write const& write) {
    std::map<std::string, std::string> const about = {{"version", version()},
                                                      {"seed", fmt::format("{}", t.recipe.seed)},
                                                      {"area_from", t.terrain.areas.source},
                                                      {"height_unit", name_of(t.recipe.output.units)}};
    auto const user = user_data(t, t.terrain.rivers.network.planform);
    io::NetworkTables const tables{t.terrain.rivers.network,
                                   t.terrain.rivers.orders,
                                   t.terrain.areas.us_area_m2,
                                   t.terrain.areas.ds_area_m2,
                                   t.terrain.areas.node_m2,
                                   t.terrain.grid.crs,
                                   about,
                                   t.terrain.rivers.types.braided.empty() ? nullptr : &t.terrain.rivers.types.braided,
                                   &t.terrain.ridges,
                                   t.assessment.given ? &t.assessment.given->secondary : nullptr,
                                   user ? &*user : nullptr,
                                   t.recipe.output.units,
                                   true,
                                   t.assessment.sinks};
    write(tables);
}

void write_network(Made const& t, io::OutputFolder const& out, Run const& run) {
    with_tables(t, [&](io::NetworkTables const& tables) {
        io::write_geopackage(tables, out.path("network"), run);
        io::write_shapefiles(tables, out.path("network"), run);
    });
    if (t.recipe.output.schema != io::Schema::native) {
        write_in_schema(t, out, run);
    }
    io::write_mask(river_mask(t.terrain.valley), out.path("network.tif"), run);
    if (t.terrain.lakes > 0) {
        io::write_mask(lake_cells(t.terrain.channels), out.path("lakes.tif"), run);
    }
}

void write_water(Made const& t, io::OutputFolder const& out, Run const& run) {
    if (t.assessment.catchments) {
        auto const rows = catchment_rows(flow::reaches_of(t.terrain.rivers.network.planform),
                                         t.terrain.rivers.orders.arc_basin, *t.assessment.catchments);
        io::write_catchments({t.assessment.catchments->reach, rows}, out.path("catchments.gpkg"), run);
    }
    if (t.assessment.water_areas) {
        io::write_field(t.assessment.water_areas->d8, out.path("area_d8.tif"), run);
        io::write_field(t.assessment.water_areas->dinf, out.path("area_dinf.tif"), run);
    }
}

ElevatedNetwork const* network_of(Made const& t) {
    return t.recipe.network ? &t.terrain.rivers.network : nullptr;
}

NetworkOrders const* orders_of(Made const& t) {
    return t.recipe.network ? &t.terrain.rivers.orders : nullptr;
}

draw::Picture map_with(Made const& t, std::vector<io::ContourLine> const& contours, draw::MapParams const& map,
                       Run const& run) {
    Raster<float> const& dem = t.terrain.surface->dem;
    Raster<std::uint8_t> const shade = io::hillshade(dem);
    draw::MapSheet sheet{dem, shade, network_of(t), orders_of(t), {}, &t.terrain.ridges, t.terrain.areas.ds_area_m2};
    for (auto const& [z, line] : contours) {
        sheet.contours.emplace_back(z, line);
    }
    Mask const lakes = t.terrain.lakes > 0 ? lake_cells(t.terrain.channels) : Mask{};
    sheet.lakes = &lakes;
    return draw_land(std::move(sheet), sea_of(t.terrain), map, run);
}

void write_surface(Made const& t, std::string const& title, io::OutputFolder const& out, Run const& run) {
    Raster<float> const& dem = t.terrain.surface->dem;
    HeightUnit const unit = t.recipe.output.units;
    double const interval = contour_interval_m(t);
    auto const contours = io::contours(dem, interval, run);
    if (unit == HeightUnit::metre) {
        io::write_dem(dem, out.path("dem.tif"), run);
        io::write_contours(contours, interval, t.terrain.grid.crs, out.path("contours.gpkg"), run);
    } else {
        Raster<float> const converted = in_unit(dem, unit);
        double const step = contour_interval(t);
        io::write_dem(converted, out.path("dem.tif"), unit, run);
        io::write_contours(io::contours(converted, step, run), step, t.terrain.grid.crs, out.path("contours.gpkg"),
                           unit, run);
    }

    draw::MapParams map;
    map.title = title;
    map.contour_interval_m = interval;
    io::write_text(out.path("map.png"), map_with(t, contours, map, run).bytes);
    ElevatedNetwork const* const network = network_of(t);
    NetworkOrders const* const orders = orders_of(t);
    if (!t.terrain.surface->increments.empty()) {
        io::write_text(
            out.path("curve.svg"),
            draw::curve(t.terrain.surface->increments, {t.recipe.surface->dilate.increment.increment}).bytes);
    }
    draw::WireframeScene const land{dem, network, orders};
    draw::WireframeParams wireframe;
    wireframe.title = title;
    wireframe.azimuth_deg = draw::azimuth_up_valley(land);
    io::write_text(out.path("wireframe.svg"), draw::wireframe(land, wireframe).bytes);
    draw::SectionsParams sections;
    sections.title = title;
    io::write_text(out.path("sections.svg"), draw::sections(dem, network, orders, sections).bytes);
}

} // namespace

void write_rivers(Made const& made, std::string const& path, Run const& run) {
    refuse_if<BadInput>(!made.recipe.network,
                        "pipeline.write_rivers: the recipe has no [network]: there are no rivers");
    with_tables(made, [&](io::NetworkTables const& tables) { io::write_geopackage(tables, path, run); });
}

draw::Picture draw_map(Made const& made, DrawMapParams const& params, Run const& run) {
    refuse_if<BadInput>(!made.terrain.surface,
                        "pipeline.draw_map: the recipe asks for rivers alone: there is no terrain to draw");
    double const interval = contour_interval_m(made);
    draw::MapParams map;
    map.title = params.title.value_or(title_of(made.recipe));
    map.contour_interval_m = interval;
    map.width_px = params.width_px;
    return map_with(made, io::contours(made.terrain.surface->dem, interval, run), map, run);
}

void check_folder(std::string const& folder, io::Existing existing) {
    io::OutputFolder const probe(folder, existing, files_left_in(folder));
}

std::vector<std::string> write_terrain(Made const& made, std::string const& folder, io::Existing existing,
                                       Run const& run) {
    io::OutputFolder out(folder, existing, files_left_in(folder));
    run.at(0.0, "write");
    Recipe const recipe = keep_inputs(made.recipe, out);
    if (made.recipe.network) {
        write_network(made, out, run);
    }
    if (made.terrain.tin && made.recipe.skeleton && made.recipe.skeleton->tin) {
        HeightUnit const unit = made.recipe.output.units;
        Tin const tin = in_unit(*made.terrain.tin, unit);
        io::write_tin(tin, made.terrain.grid.crs, out.path("tin.2dm"), io::TinFormat::mesh_2dm, unit, run);
        io::write_tin(tin, made.terrain.grid.crs, out.path("tin.ply"), io::TinFormat::ply, unit, run);
    }
    run.at(0.3, "write");
    std::string const title = title_of(made.recipe);
    if (made.terrain.surface) {
        write_surface(made, title, out, run);
        write_water(made, out, run);
    }
    if (made.recipe.network) {
        draw::ProfileParams profile;
        profile.title = title;
        io::write_text(out.path("profile.svg"),
                       draw::profile(made.terrain.rivers.network, made.terrain.rivers.orders, profile).bytes);
    }
    write_qgis_files(made, title, out);
    std::string const recipe_toml = write_recipe(recipe);
    io::write_text(out.path("recipe.toml"), recipe_toml);
    io::write_text(out.path("report.html"), page(made, page_params_of(made, recipe_toml), run));
    run.at(0.9, "write");
    std::vector<std::string> files = out.files();
    files.emplace_back("report.json");
    io::write_text(out.path("report.json"), write_report(made, files));
    run.at(1.0, "write");
    out.commit();
    return files;
}

} // namespace thalweg::pipeline
