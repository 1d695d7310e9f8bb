// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/pictures.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/box_means.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/draw/diagrams.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/draw/sections.hpp>
#include <thalweg/draw/wireframe.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/raster/dem_derivatives.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/measure/relief/hypsometry.hpp>

namespace thalweg::report {

namespace {

ElevatedNetwork const* network_of(Scene const& scene) {
    return scene.network ? &*scene.network : nullptr;
}

NetworkOrders const* orders_of(Scene const& scene) {
    return scene.network ? &scene.orders : nullptr;
}

draw::Picture draw_map(Scene const& scene, Look const& look, Run const& run) {
    Raster<float> const& dem = *scene.dem;
    draw::MapParams params;
    params.title = scene.title;
    params.format = look.format;
    params.width_px = look.width_px > 0 ? look.width_px : params.width_px;
    Overview const seen = overview_of(dem, draw::columns_of_map(dem.grid(), params), run);
    double const relief = seen.range ? seen.range->second - seen.range->first : 0.0;
    double const interval = scene.contour_interval_m > 0.0 ? scene.contour_interval_m : round_interval(relief);
    ShownLand const land(dem, seen, scene.lakes, run);
    draw::MapSheet sheet = land.sheet();
    sheet.network = network_of(scene);
    sheet.orders = orders_of(scene);
    sheet.areas_m2 = scene.ds_area_m2;
    sheet.contours = land.contours(interval, run);
    params.contour_interval_m = sheet.contours.empty() ? 0.0 : interval;
    return draw_land(std::move(sheet), scene.sea, summits(dem, seen, summits_named, run), params);
}

draw::Picture draw_wireframe(Scene const& scene, Look const& look) {
    draw::WireframeScene const land{*scene.dem, network_of(scene), orders_of(scene)};
    draw::WireframeParams params;
    params.title = scene.title;
    params.azimuth_deg = look.azimuth_deg ? *look.azimuth_deg : draw::azimuth_up_valley(land);
    params.elevation_deg = look.elevation_deg.value_or(params.elevation_deg);
    params.exaggeration = look.exaggeration.value_or(params.exaggeration);
    params.format = look.format;
    params.width_px = look.width_px > 0 ? look.width_px : params.width_px;
    return draw::wireframe(land, params);
}

/// Pictures with a fixed aspect ratio keep it at another width.
template <class Params> Params sized(Look const& look) {
    Params params;
    params.format = look.format;
    if (look.width_px > 0) {
        params.height_px = std::clamp(params.height_px * look.width_px / params.width_px, 200, 8000);
        params.width_px = look.width_px;
    }
    return params;
}

draw::Picture draw_hypsometry(Scene const& scene, Look const& look, Run const& run) {
    measure::Hypsometry const found = measure::hypsometry(*scene.dem, run);
    std::vector<Vec2> curve;
    for (measure::HypsometricPoint const& point : found.points) {
        curve.push_back({point.share_above, point.z});
    }
    draw::HypsometryParams params = sized<draw::HypsometryParams>(look);
    params.title = scene.title;
    return draw::hypsometry(curve, found.integral, params);
}

/// "WGS 84 / UTM zone 31N (EPSG:32631)", without a code the name; "": neither.
std::string crs_on_map(std::string const& crs) {
    std::string const words = io::crs_in_words(crs);
    return words.empty() || !crs.starts_with("EPSG:") ? words : fmt::format("{} ({})", words, crs);
}

} // namespace

std::vector<PictureKind> const& picture_kinds() {
    static std::vector<PictureKind> const kinds = {PictureKind::map,      PictureKind::profile,
                                                   PictureKind::curve,    PictureKind::hypsometry,
                                                   PictureKind::sections, PictureKind::wireframe};
    return kinds;
}

char const* name_of(PictureKind kind) {
    switch (kind) {
    case PictureKind::map: return "map";
    case PictureKind::profile: return "profile";
    case PictureKind::curve: return "curve";
    case PictureKind::hypsometry: return "hypsometry";
    case PictureKind::sections: return "sections";
    case PictureKind::wireframe: break;
    }
    return "wireframe";
}

ShownLand::ShownLand(Raster<float> const& dem, Overview const& seen, Mask const& lakes, Run const& run)
    : dem_(dem), seen_(seen), lakes_(lakes) {
    if (!is_whole() && lakes.cells() > 0) {
        lakes_shown_ = box_means(lakes, seen.means.width(), run);
    }
    hillshade_ = io::hillshade(this->dem());
}

draw::MapSheet ShownLand::sheet() const {
    draw::MapSheet sheet{dem(), hillshade_, nullptr, nullptr, {}};
    sheet.lakes = is_whole() ? &lakes_ : &lakes_shown_;
    if (!is_whole()) {
        auto const heights = seen_.range.value_or(std::pair(1.0, 0.0));
        sheet.whole = draw::WholeDem{dem_.grid(), heights.first, heights.second};
    }
    return sheet;
}

std::vector<std::pair<double, std::vector<Vec2>>> ShownLand::contours(double interval_m, Run const& run) const {
    std::int64_t const half = std::max<std::int64_t>(1, seen_.means.width() / 2);
    Raster<float> const smooth = is_whole() ? Raster<float>{} : box_means(seen_.means, half, run);
    std::vector<std::pair<double, std::vector<Vec2>>> lines;
    for (io::ContourLine& contour : io::contours(is_whole() ? dem_ : smooth, interval_m, run)) {
        lines.emplace_back(contour.z, std::move(contour.line));
    }
    return lines;
}

draw::Picture draw_land(draw::MapSheet sheet, std::optional<Sea> const& sea, std::vector<Summit> const& summits,
                        draw::MapParams params) {
    if (sea) {
        sheet.sea = draw::Sea{sea->is_around};
    }
    for (Summit const& summit : summits) {
        sheet.spot_heights.push_back({summit.at, summit.z});
    }
    params.crs = crs_on_map(sheet.dem.grid().crs);
    return draw::map(sheet, params);
}

double round_interval(double relief_m) {
    double step = 1e-3;
    while (step * 20.0 < relief_m) {
        for (double const factor : {2.0, 2.5, 2.0}) { // 1, 2, 5, 10
            step *= factor;
            if (step * 20.0 >= relief_m) {
                break;
            }
        }
    }
    return step;
}

draw::LayersBelow layers_below(recipe::Recipe const& recipe, Raster<float> const& dem, double shift_m) {
    surface::Strata const strata = make::strata_of(recipe, dem.grid());
    draw::LayersBelow below;
    below.bed = surface::bed_heights(dem.grid(), strata, shift_m);
    std::optional<std::pair<double, double>> const heights = height_range(dem);
    auto const [low_bed, high_bed] = std::minmax_element(below.bed.values().begin(), below.bed.values().end());
    double const margin_m = heights ? heights->second - heights->first : 0.0; // panels reach somewhat lower
    double const low_m = heights ? heights->first - margin_m - static_cast<double>(*high_bed) : 0.0;
    double const high_m = heights ? heights->second - static_cast<double>(*low_bed) : 0.0;
    for (surface::StackedLayer const& stacked : surface::stack_of(strata, low_m, high_m)) {
        below.layers.push_back({stacked.top_m, strata.layers[stacked.layer].strength});
    }
    return below;
}

std::string missing_for(PictureKind kind, Scene const& scene) {
    switch (kind) {
    case PictureKind::profile: return scene.network ? "" : "there are no rivers: name a file of them with --network";
    case PictureKind::curve:
        return scene.increments.empty() ? "there is no recipe with a surface: it is drawn from a folder written by make"
                                        : "";
    case PictureKind::map:
    case PictureKind::hypsometry:
    case PictureKind::sections:
    case PictureKind::wireframe: break;
    }
    return scene.dem ? "" : "there is no DEM";
}

draw::Picture draw_picture(PictureKind kind, Scene const& scene, Look const& look, Run const& run) {
    if (std::string const missing = missing_for(kind, scene); !missing.empty()) {
        throw BadInput("report.draw_picture", fmt::format("no {} can be drawn, {}", name_of(kind), missing));
    }
    switch (kind) {
    case PictureKind::map: return draw_map(scene, look, run);
    case PictureKind::profile: {
        draw::ProfileParams params = sized<draw::ProfileParams>(look);
        params.title = scene.title;
        return draw::profile(*scene.network, scene.orders, params);
    }
    case PictureKind::hypsometry: return draw_hypsometry(scene, look, run);
    case PictureKind::wireframe: return draw_wireframe(scene, look);
    case PictureKind::sections: {
        draw::SectionsParams params;
        params.title = scene.title;
        params.below = scene.rock;
        params.format = look.format;
        params.width_px = look.width_px > 0 ? look.width_px : params.width_px;
        return draw::sections(*scene.dem, network_of(scene), orders_of(scene), params);
    }
    case PictureKind::curve: break;
    }
    draw::CurveParams params = sized<draw::CurveParams>(look);
    params.increment = scene.increment;
    return draw::curve(scene.increments, params);
}

} // namespace thalweg::report
