// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/export/internal/web_export.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/draw/wireframe.hpp>
#include <thalweg/export/internal/web_template.hpp>
#include <thalweg/io/gdal/packed.hpp>
#include <thalweg/io/raster/dem_derivatives.hpp>
#include <thalweg/report/landmarks.hpp>
#include <thalweg/report/page.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::exports {
namespace {

using WebJson = nlohmann::ordered_json;

std::string web_dump(WebJson const& json) {
    return json.dump(-1, ' ', false, WebJson::error_handler_t::replace);
}

/// The DEM without holes, and where it has data.
struct WebHeights {
    Raster<float> z;
    Mask shown;
    std::int64_t holes = 0;
};

WebHeights without_holes(report::Scene const& scene, std::vector<Finding>& findings, Run const& run) {
    Raster<float> const& dem = *scene.dem;
    WebHeights out{dem, Mask(dem.grid(), 1), 0};
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isnan(dem[i])) {
            out.shown[i] = 0;
            ++out.holes;
        }
    }
    if (out.holes == 0) {
        return out;
    }
    std::string const count = fmt::format("{} of {} cells", out.holes, dem.cells());
    if (scene.sea) {
        for (float& z : out.z.values()) {
            z = std::isnan(z) ? static_cast<float>(scene.sea->level_m) : z;
        }
        std::ranges::fill(out.shown.values(), std::uint8_t{1});
        findings.push_back({.kind = "level_sea",
                            .amount = scene.sea->level_m,
                            .text = fmt::format("the sea, {}, lies level at {} m", count, scene.sea->level_m)});
        return out;
    }
    Raster<std::int64_t> const nearest = nearest_cells(out.shown, run);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        out.z[i] = dem[nearest[i]];
    }
    findings.push_back(
        {.kind = "holes",
         .amount = static_cast<double>(out.holes),
         .text = fmt::format("{} have no data: they are transparent, at the height of the nearest cell", count)});
    return out;
}

std::string web_picture(report::Scene const& scene, Run const& run) {
    run.at(0.0, "texture");
    Raster<float> const& dem = *scene.dem;
    constexpr double least_px = 200.0;
    constexpr double fewest_px = 1024.0; // of the longer side
    constexpr double most_px = 6000.0;
    auto const wide = static_cast<double>(dem.width());
    auto const high = static_cast<double>(dem.height());
    double const longer_px = std::clamp(2.0 * std::max(wide, high), fewest_px, most_px);
    double const shape = std::min(1.0, (wide - 1.0) / std::max(1.0, high - 1.0));
    draw::GroundParams params;
    params.shading = 0.8; // the page adds none
    params.width_px = static_cast<int>(std::max(least_px, std::floor(longer_px * shape + 0.5)));
    Overview const seen = overview(dem, draw::columns_of_ground(dem.grid(), params), 1, run);
    report::ShownLand const land(dem, seen, scene.lakes, run);
    draw::MapSheet sheet = land.sheet();
    if (scene.sea) {
        sheet.sea = draw::Sea{scene.sea->is_around};
    }
    return draw::ground(sheet, params).bytes;
}

/// Width of a river's line [px]: by the root of the area, as on maps, or by order.
std::vector<double> web_widths(report::Scene const& scene) {
    std::vector<int> const& orders = scene.orders.strahler;
    std::vector<double> const& areas = scene.ds_area_m2;
    int const highest = orders.empty() ? 1 : *std::ranges::max_element(orders);
    double const largest = areas.empty() ? 0.0 : *std::ranges::max_element(areas);
    double const widest = std::min(0.9 * (highest - 1), 4.2);
    std::vector<double> out;
    for (std::size_t arc = 0; arc < orders.size(); ++arc) {
        double const share = largest > 0.0 ? std::sqrt(std::max(0.0, areas[arc]) / largest)
                                           : static_cast<double>(orders[arc] - 1) / std::max(1, highest - 1);
        out.push_back(std::floor((1.2 + widest * share) * 100.0 + 0.5) / 100.0);
    }
    return out;
}

/// A FeatureCollection of the rivers from an order on.
std::string geojson_from(int order, std::vector<std::vector<Vec2>> const& lines, std::vector<double> const& widths,
                         report::Scene const& scene) {
    WebJson features = WebJson::array();
    for (std::size_t arc = 0; arc < lines.size(); ++arc) {
        if (scene.orders.strahler[arc] < order) {
            continue;
        }
        WebJson places = WebJson::array();
        for (Vec2 const p : lines[arc]) {
            places.push_back({p.x, p.y});
        }
        features.push_back({{"type", "Feature"},
                            {"properties", {{"strahler", scene.orders.strahler[arc]}, {"width", widths[arc]}}},
                            {"geometry", {{"type", "LineString"}, {"coordinates", std::move(places)}}}});
    }
    return web_dump({{"type", "FeatureCollection"}, {"features", std::move(features)}});
}

/// The rivers of a scene as files and pages hold them.
struct WebRivers {
    std::string all;  ///< "": none
    std::string some; ///< of the orders that a page of limited size has room for
};

WebRivers web_rivers(report::Scene const& scene, io::WebPyramid const& pyramid, std::int64_t most_bytes,
                     std::vector<Finding>& findings) {
    if (!scene.network || scene.network->planform.arc_count() == 0) {
        return {};
    }
    std::vector<std::vector<Vec2>> lines;
    for (Arc const& arc : scene.network->planform.arcs()) {
        lines.push_back(arc.line);
    }
    lines = io::lines_in_degrees(std::move(lines), pyramid);
    std::vector<double> const widths = web_widths(scene);
    WebRivers out;
    out.all = out.some = geojson_from(1, lines, widths, scene);
    int const highest = *std::ranges::max_element(scene.orders.strahler);
    int order = 1;
    while (static_cast<std::int64_t>(out.some.size()) > most_bytes && order < highest) {
        out.some = geojson_from(++order, lines, widths, scene);
    }
    if (order > 1) {
        findings.push_back({.kind = "some_rivers",
                            .amount = static_cast<double>(order),
                            .text = fmt::format("terrain.html holds the rivers from Strahler order {} on", order)});
    }
    return out;
}

/// Tiles inside a page.
struct WebInside {
    std::string packed;                 ///< as io::packed, one after the other
    WebJson places = WebJson::object(); ///< "heights/3/1/2": [begin, size]
    std::int64_t max_zoom = 0;
};

constexpr std::int64_t largest_tile = 1 << 24;

WebInside tiles_inside(io::WebPyramid const& pyramid, io::OutputFolder const& out, std::int64_t most_bytes) {
    WebInside inside;
    std::string bytes;
    inside.max_zoom = pyramid.min_zoom;
    for (std::int64_t zoom = pyramid.min_zoom; zoom <= pyramid.max_zoom; ++zoom) {
        std::string level;
        WebJson places = WebJson::object();
        io::WebTileRange const at = io::web_tiles_at(pyramid, zoom);
        for (std::int64_t column = at.west; column <= at.east; ++column) {
            for (std::int64_t row = at.north; row <= at.south; ++row) {
                for (char const* const kind : {"heights", "colour"}) {
                    std::string const name = fmt::format("{}/{}/{}/{}", kind, zoom, column, row);
                    std::string const tile = io::read_text(out.path(name + ".png"), largest_tile);
                    places[name] = {bytes.size() + level.size(), tile.size()};
                    level += tile;
                }
            }
            if (zoom > pyramid.min_zoom &&
                static_cast<std::int64_t>(bytes.size() + level.size()) / 3 * 4 > most_bytes) {
                zoom = pyramid.max_zoom; // this level has no room
                level.clear();
                places.clear();
                break;
            }
        }
        if (!level.empty()) {
            bytes += level;
            inside.places.update(places);
            inside.max_zoom = zoom;
        }
    }
    inside.packed = io::packed({reinterpret_cast<std::uint8_t const*>(bytes.data()), bytes.size()});
    return inside;
}

std::string web_page(report::Scene const& scene, WebJson const& data, std::string const& tiles) {
    std::string const title = report::html_text(scene.title.empty() ? "Terrain" : scene.title);
    std::string const json = report::without_tags(web_dump(data));
    return report::fill_markers(web_template(), {{"@@TITLE@@", &title}, {"@@DATA@@", &json}, {"@@TILES@@", &tiles}});
}

void require_web(report::Scene const& scene, WebExportParams const& params) {
    require_in("export.write_web", "exaggeration", params.exaggeration, Range::above(0.0));
    require_in("export.write_web", "most_bytes", params.most_bytes, Range::at_least(1));
    refuse_if<BadInput>(!scene.dem, "export.write_web", "there is no DEM");
    refuse_if<BadInput>(std::ranges::all_of(scene.dem->values(), [](float z) { return std::isnan(z); }),
                        "export.write_web", "no cell has a height");
}

} // namespace

WebExport write_web(report::Scene const& scene, WebExportParams const& params, io::OutputFolder const& out,
                    Run const& run) {
    require_web(scene, params);
    Raster<float> const& dem = *scene.dem;
    WebExport made;
    WebHeights const ground = without_holes(scene, made.findings, run);
    made.holes = ground.holes;
    std::tie(made.min_m, made.max_m) = *report::height_range(ground.z);
    io::WebPyramid const pyramid = io::web_pyramid(dem.grid(), params.pyramid);
    made.min_zoom = pyramid.min_zoom;
    made.max_zoom = pyramid.max_zoom;
    made.bounds = pyramid.box;
    made.tiles = pyramid.tiles;
    if (dem.grid().crs.empty()) {
        made.findings.push_back(
            {.kind = "no_crs", .text = "the DEM has no CRS: it is laid around 0 degrees north, 0 degrees east"});
    }
    if (pyramid.max_zoom < pyramid.full_zoom) {
        made.findings.push_back(
            {.kind = "zoom_levels",
             .amount = static_cast<double>(pyramid.max_zoom),
             .text = fmt::format("zoom levels end at {}, where a sample has several cells; all cells would need level "
                                 "{}",
                                 pyramid.max_zoom, pyramid.full_zoom)});
    }
    std::string const picture = web_picture(scene, run);
    made.files = io::write_web_tiles({ground.z, ground.shown, picture}, pyramid, out, run);

    run.at(0.0, "pages");
    WebRivers const rivers = web_rivers(scene, pyramid, params.most_bytes / 4, made.findings);
    if (!rivers.all.empty()) {
        io::write_text(out.path("rivers.geojson"), rivers.all + "\n");
        made.files.emplace_back("rivers.geojson");
    }
    draw::WireframeScene const valley{dem, scene.network ? &*scene.network : nullptr,
                                      scene.network ? &scene.orders : nullptr};
    WebJson data{{"thalweg", report::version()},
                 {"title", scene.title},
                 {"bounds", {made.bounds.west, made.bounds.south, made.bounds.east, made.bounds.north}},
                 {"min_zoom", made.min_zoom},
                 {"max_zoom", made.max_zoom},
                 {"min_m", made.min_m},
                 {"max_m", made.max_m},
                 {"bearing", std::floor(draw::azimuth_up_valley(valley) + 0.5)},
                 {"exaggeration", params.exaggeration}};
    data["rivers"] = rivers.all.empty() ? WebJson() : WebJson("rivers.geojson");
    data["tiles"] = nullptr;
    io::write_text(out.path("index.html"), web_page(scene, data, ""));

    std::int64_t const taken = static_cast<std::int64_t>(web_template().size() + rivers.some.size());
    WebInside const inside = tiles_inside(pyramid, out, params.most_bytes - taken);
    made.page_max_zoom = inside.max_zoom;
    if (inside.max_zoom < pyramid.max_zoom) {
        made.findings.push_back(
            {.kind = "zoom_levels",
             .amount = static_cast<double>(inside.max_zoom),
             .text = fmt::format("terrain.html ends at zoom level {} of {}: more would take over {} MB",
                                 inside.max_zoom, pyramid.max_zoom, params.most_bytes / 1'000'000)});
    }
    data["max_zoom"] = inside.max_zoom;
    data["tiles"] = inside.places;
    if (!rivers.some.empty()) {
        data["rivers"] = WebJson::parse(rivers.some);
    }
    io::write_text(out.path("terrain.html"), web_page(scene, data, inside.packed));
    made.files.insert(made.files.end(), {"index.html", "terrain.html"});
    std::ranges::sort(made.files);
    run.at(1.0, "pages");
    return made;
}

} // namespace thalweg::exports
