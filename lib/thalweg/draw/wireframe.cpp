// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/wireframe.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <cairo.h>
#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/draw/internal/axes.hpp>
#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/fishnet.hpp>
#include <thalweg/draw/internal/hidden_lines.hpp>
#include <thalweg/draw/internal/main_stem.hpp>
#include <thalweg/draw/internal/wireframe_model.hpp>

namespace thalweg::draw {
namespace {

constexpr int orders_shown = 3; // the smaller streams would only hide the net
constexpr Colour skirt_line{0.55, 0.55, 0.57};
constexpr Colour river_line{0.08, 0.36, 0.72};

void demand_scene(WireframeScene const& scene, WireframeParams const& params) {
    require_in("draw.wireframe", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    constexpr char const* stage = "draw.wireframe";
    require_in(stage, "azimuth_deg", params.azimuth_deg, Range::between(-36000.0, 36000.0));
    require_in(stage, "elevation_deg", params.elevation_deg, Range::between(5.0, 85.0));
    require_in(stage, "exaggeration", params.exaggeration, Range::between(0.0, 1e6));
    require_in(stage, "lines", params.lines, Range::between(2, 200));
    Grid const& grid = scene.dem.grid();
    if (grid.width < 1 || grid.height < 1 || !(grid.cell_m > 0.0) || !std::isfinite(grid.cell_m)) {
        throw BadInput(fmt::format("draw.wireframe: a DEM of {} x {} cells of {} m; draw one that has some", grid.width,
                                   grid.height, grid.cell_m));
    }
    if (scene.network != nullptr) {
        std::size_t const arcs = scene.network->plan.arc_count();
        if (scene.orders == nullptr || scene.orders->strahler.size() != arcs) {
            throw BadInput(fmt::format("draw.wireframe: a network of {} arcs comes with {} orders; order this network",
                                       arcs, scene.orders == nullptr ? 0 : scene.orders->strahler.size()));
        }
    }
}

/// Rivers as threads on the net, with their order.
struct Rivers {
    std::vector<Thread> threads;
    std::vector<int> order;
    int highest = 0;
};

/// Place among ascending numbers: whole numbers are their indices. Beyond the ends it goes on at the same pace.
double index_of(std::vector<double> const& at, double value) {
    double const step = (at.back() - at.front()) / static_cast<double>(at.size() - 1);
    return (value - at.front()) / step;
}

Rivers rivers_on(WireframeScene const& scene, Fishnet const& knots) {
    Rivers rivers;
    if (scene.network == nullptr) {
        return rivers;
    }
    Grid const& grid = scene.dem.grid();
    for (int const order : scene.orders->strahler) {
        rivers.highest = std::max(rivers.highest, order);
    }
    for (ArcId a = 0; a < scene.network->plan.arc_count(); ++a) {
        int const order = scene.orders->strahler[a];
        if (order <= rivers.highest - orders_shown) {
            continue;
        }
        Thread thread;
        for (Vec2 const p : scene.network->plan.arc(a).line) {
            Vec2 const at{index_of(knots.col_at, (p.x - grid.west) / grid.cell_m - 0.5),
                          index_of(knots.row_at, (grid.north - p.y) / grid.cell_m - 0.5)};
            // What lies far off the net is not drawn, but would be cut at every line between.
            bool const near = std::fabs(at.x) < 1e4 && std::fabs(at.y) < 1e4;
            if (near && (thread.empty() || distance(thread.back(), at) > 0.02)) {
                thread.push_back(at);
            }
        }
        rivers.threads.push_back(std::move(thread));
        rivers.order.push_back(order);
    }
    return rivers;
}

/// "the south-west" for where the eye is.
char const* quarter_of(double azimuth_deg) {
    constexpr std::array<char const*, 8> quarters = {"south", "south-west", "west", "north-west",
                                                     "north", "north-east", "east", "south-east"};
    double const turns = azimuth_deg / 360.0;
    double const eighth = 8.0 * (turns - std::floor(turns));
    return quarters[static_cast<std::size_t>(eighth + 0.5) % quarters.size()];
}

std::string length_text(double metres) {
    if (metres < 1000.0) {
        return number(metres, metres < 10.0 ? 1 : 0) + " m";
    }
    return number(metres / 1000.0, metres < 100000.0 ? 1 : 0) + " km";
}

void stroke(Cairo* sheet, Colour colour, double width) {
    set_colour(sheet, colour);
    cairo_set_line_width(sheet, width);
    cairo_stroke(sheet);
}

/// An arrow on the ground that points north.
void draw_north(Cairo* sheet, Vec2 at, View const& view, double unit) {
    Vec2 const tip = view.at({0.0, 1.0}, 0.0);
    Vec2 const along{tip.x * 26.0 * unit, -tip.y * 26.0 * unit};
    Vec2 const side = view.at({1.0, 0.0}, 0.0);
    Vec2 const across{side.x * 6.0 * unit, -side.y * 6.0 * unit};
    Vec2 const head = at + along;
    Vec2 const neck{at.x + 0.35 * along.x, at.y + 0.35 * along.y};
    draw_line(sheet, at - along, neck, 0.9 * unit, faint_ink);
    cairo_move_to(sheet, head.x, head.y);
    cairo_line_to(sheet, neck.x + across.x, neck.y + across.y);
    cairo_line_to(sheet, neck.x - across.x, neck.y - across.y);
    cairo_close_path(sheet);
    set_colour(sheet, faint_ink);
    cairo_fill(sheet);
    double const length = std::max(1.0, distance({0.0, 0.0}, along));
    double const off = length + 10.0 * unit;
    draw_text(sheet, {at.x + along.x / length * off, at.y + along.y / length * off + 4.0 * unit}, "N",
              {12.0 * unit, faint_ink}, Anchor::middle);
}

/// Where the model stands on the sheet; lengths in pixels.
struct Sheet {
    double width;
    double unit; ///< a pixel of a sheet 1200 wide
    double margin;
    double top;
    double scale; ///< [px/m]
    double height;
    Vec2 corner; ///< the model's lower left one

    Vec2 at(Box const& box, Vec2 p) const {
        return {corner.x + (p.x - box.x) * scale, corner.y - (p.y - box.y) * scale};
    }
    double line_px() const { return std::max(0.45, 0.62 * unit); }
};

Sheet sheet_for(Box const& box, WireframeParams const& params) {
    Sheet sheet{};
    sheet.width = params.width_px;
    sheet.unit = std::max(0.5, sheet.width / 1200.0);
    sheet.margin = 30.0 * sheet.unit;
    sheet.top = (params.title.empty() ? 24.0 : 74.0) * sheet.unit;
    double const below = 92.0 * sheet.unit; // lengths of the sides, caption, arrow
    sheet.scale = std::min((sheet.width - 2.0 * sheet.margin) / std::max(box.width, 1e-300),
                           0.75 * sheet.width / std::max(box.height, 1e-300));
    double const ground_high = sheet.scale * box.height;
    sheet.height = std::ceil(std::clamp(sheet.top + ground_high + below, 0.2 * sheet.width, 2.0 * sheet.width));
    sheet.corner = {0.5 * (sheet.width - sheet.scale * box.width), sheet.top + ground_high};
    return sheet;
}

void trace_straight(Cairo* cairo, std::vector<std::array<Vec2, 2>> const& lines, Sheet const& sheet, Box const& box) {
    for (auto const& line : lines) {
        trace_line(cairo, {sheet.at(box, line[0]), sheet.at(box, line[1])}, 0.0);
    }
}

/// A line of the hidden-line removal, whose y grows upwards.
void trace_upward(Cairo* cairo, std::vector<Vec2> line) {
    for (Vec2& p : line) {
        p.y = -p.y;
    }
    trace_line(cairo, line, 0.0);
}

void draw_net(Cairo* cairo, Model const& model, Seen const& seen, Sheet const& sheet) {
    trace_straight(cairo, model.skirt, sheet, model.box);
    stroke(cairo, skirt_line, 0.8 * sheet.line_px());
    trace_straight(cairo, model.bottom, sheet, model.box);
    stroke(cairo, ink, 1.3 * sheet.line_px());
    for (auto const& line : seen.net) {
        trace_upward(cairo, line);
    }
    stroke(cairo, ink, sheet.line_px());
}

void draw_threads(Cairo* cairo, Rivers const& rivers, Seen const& seen, Sheet const& sheet) {
    for (int order = 1; order <= rivers.highest; ++order) {
        for (SeenThread const& river : seen.threads) {
            if (rivers.order[river.thread] == order) {
                trace_upward(cairo, river.line);
            }
        }
        double const share = 1.0 - 0.35 * (rivers.highest - order);
        stroke(cairo, river_line, std::max(1.1 * sheet.line_px(), 2.4 * sheet.unit * share));
    }
}

/// Writes the length of a front edge beside it, where there is room.
void name_side(Cairo* cairo, Model const& model, Vec2 end, double metres, Sheet const& sheet) {
    double const unit = sheet.unit;
    Vec2 const from = sheet.at(model.box, model.base_corner);
    Vec2 const to = sheet.at(model.box, end);
    if (distance(from, to) < 60.0 * unit) {
        return;
    }
    Vec2 const middle{0.5 * (from.x + to.x), 0.5 * (from.y + to.y)};
    bool const left = to.x < from.x;
    draw_text(cairo, {middle.x + (left ? -8.0 : 8.0) * unit, middle.y + 19.0 * unit}, length_text(metres),
              {13.0 * unit, faint_ink}, left ? Anchor::end : Anchor::start);
}

void name_sides(Cairo* cairo, Model const& model, Grid const& grid, Sheet const& sheet) {
    auto const extent_m = [&](std::vector<double> const& at, std::int64_t cells) {
        // Knots stand in the middle of cells, so that the land reaches half a cell further.
        double const reach = at.back() - at.front();
        return grid.cell_m * (cells == 1 ? 1.0 : std::min(static_cast<double>(cells), reach + 1.0));
    };
    name_side(cairo, model, model.base_col_end, extent_m(model.knots.col_at, grid.width), sheet);
    name_side(cairo, model, model.base_row_end, extent_m(model.knots.row_at, grid.height), sheet);
}

std::string caption_of(Model const& model, double cell_m, WireframeParams const& params) {
    Fishnet const& knots = model.knots;
    std::string caption = fmt::format("seen from the {}, {:.0f}° above the horizon   ·   heights ×{:.6g}",
                                      quarter_of(params.azimuth_deg), params.elevation_deg, model.exaggeration);
    if (knots.low_m <= knots.high_m) {
        double const mesh_m =
            cell_m * (knots.col_at.back() - knots.col_at.front()) / static_cast<double>(knots.columns - 1);
        double const relief = knots.high_m - knots.low_m;
        int const decimals = relief < 10.0 && relief > 0.0 ? 1 : 0;
        caption += fmt::format("   ·   {}{} m   ·   lines {} apart", number(knots.low_m, decimals),
                               relief > 0.0 ? " – " + number(knots.high_m, decimals) : "", length_text(mesh_m));
    }
    return caption;
}

} // namespace

double azimuth_up_valley(WireframeScene const& scene) {
    constexpr double standard = 30.0;
    if (scene.network == nullptr || scene.orders == nullptr) {
        return standard;
    }
    std::vector<Vec2> const stem = main_stem(scene.network->plan, *scene.orders).line;
    if (stem.empty()) {
        return standard;
    }
    Grid const& grid = scene.dem.grid();
    Vec2 const middle{0.5 * (grid.west + grid.east()), 0.5 * (grid.south() + grid.north)};
    double const east = middle.x - stem.front().x;
    double const north = middle.y - stem.front().y;
    if (!(std::fabs(east) + std::fabs(north) > 0.0) || !std::isfinite(east) || !std::isfinite(north)) {
        return standard;
    }
    double const bearing = std::atan2(east, north) / degree + 360.0;
    double const axis = 90.0 * std::floor(bearing / 90.0 + 0.5);
    double const off = bearing - axis;
    // Between end on and the diagonal, where squares turn into a chequer-board.
    double const kept = std::copysign(std::clamp(std::fabs(off), 20.0, 35.0), off == 0.0 ? 1.0 : off);
    double const turned = axis + kept;
    return turned - 360.0 * std::floor(turned / 360.0);
}

Picture wireframe(WireframeScene const& scene, WireframeParams const& params) {
    demand_scene(scene, params);
    Model const model = model_of(scene.dem, params);
    Rivers const rivers = rivers_on(scene, model.knots);
    Sheet const sheet = sheet_for(model.box, params);
    double const unit = sheet.unit;
    Net net = model.net;
    for (Vec2& p : net.at) {
        Vec2 const at = sheet.at(model.box, p);
        p = {at.x, -at.y};
    }
    Seen const seen = hidden_lines(net, rivers.threads, 0.8 * unit);
    View const view(params.azimuth_deg, params.elevation_deg, model.exaggeration);

    return paint(sheet.width, sheet.height, params.format, [&](Cairo* cairo) {
        draw_text_within(cairo, {sheet.margin, 42.0 * unit}, params.title, {24.0 * unit, ink, Weight::bold},
                         sheet.width - 2.0 * sheet.margin);
        cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
        draw_net(cairo, model, seen, sheet);
        draw_threads(cairo, rivers, seen, sheet);
        cairo_set_line_cap(cairo, CAIRO_LINE_CAP_BUTT);

        TextStyle const small{13.0 * unit, faint_ink};
        if (model.knots.low_m > model.knots.high_m) {
            draw_text(cairo, {0.5 * sheet.width, 0.5 * (sheet.top + sheet.corner.y)}, "no heights", small,
                      Anchor::middle);
        }
        name_sides(cairo, model, scene.dem.grid(), sheet);
        draw_text_within(cairo, {sheet.margin, sheet.height - 20.0 * unit},
                         caption_of(model, scene.dem.grid().cell_m, params), small,
                         sheet.width - 2.0 * sheet.margin - 70.0 * unit);
        draw_north(cairo, {sheet.width - sheet.margin - 26.0 * unit, sheet.height - 34.0 * unit}, view, unit);
    });
}

} // namespace thalweg::draw
