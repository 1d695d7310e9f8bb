// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/wireframe.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <cairo.h>
#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/sections.hpp>
#include <thalweg/draw/internal/wireframe.hpp>

namespace thalweg::draw {
namespace {

/// The columns and rows with heights; all of them if there are none.
struct Extent {
    std::int64_t west = 0;
    std::int64_t east = 0;
    std::int64_t north = 0;
    std::int64_t south = 0;
};

Extent extent_of(Raster<float> const& dem) {
    Extent box{dem.width(), -1, dem.height(), -1};
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        for (std::int64_t col = 0; col < dem.width(); ++col) {
            if (std::isfinite(dem[Cell{col, row}])) {
                box = {std::min(box.west, col), std::max(box.east, col), std::min(box.north, row), row};
            }
        }
    }
    return box.east < 0 ? Extent{0, dem.width() - 1, 0, dem.height() - 1} : box;
}

/// Positions of the lines across one direction [cells].
std::vector<double> spread(std::int64_t first, std::int64_t last, double apart) {
    auto const start = static_cast<double>(first);
    if (first == last) {
        return {start - 0.5, start + 0.5};
    }
    double const span = static_cast<double>(last - first);
    auto const meshes = static_cast<std::int64_t>(std::max(1.0, std::floor(span / apart + 0.5)));
    std::vector<double> at(static_cast<std::size_t>(meshes + 1));
    for (std::size_t k = 0; k < at.size(); ++k) {
        at[k] = start + span * static_cast<double>(k) / static_cast<double>(meshes);
    }
    return at;
}

/// Mean of the cells around a position; NaN: fewer than half of them have heights.
double mean_around(Raster<float> const& dem, double col, double row, double reach) {
    auto const clamped = [](double v, std::int64_t cells) {
        return std::clamp(static_cast<std::int64_t>(std::floor(v + 0.5)), std::int64_t{0}, cells - 1);
    };
    std::int64_t const west = clamped(col - reach, dem.width());
    std::int64_t const east = clamped(col + reach, dem.width());
    std::int64_t const north = clamped(row - reach, dem.height());
    std::int64_t const south = clamped(row + reach, dem.height());
    double sum = 0.0;
    std::int64_t known = 0;
    for (std::int64_t r = north; r <= south; ++r) {
        for (std::int64_t c = west; c <= east; ++c) {
            float const z = dem[Cell{c, r}];
            if (std::isfinite(z)) {
                sum += static_cast<double>(z);
                ++known;
            }
        }
    }
    return 2 * known >= (south - north + 1) * (east - west + 1) ? sum / static_cast<double>(known)
                                                                : std::numeric_limits<double>::quiet_NaN();
}

constexpr double degree = 3.14159265358979323846 / 180.0;

// Parallel projection, in metres: x to the right, y up.
struct View {
    double sine = 0.0; // of the bearing
    double cosine = 1.0;
    double tilt = 0.5;    // share of depth in y
    double upright = 1.0; // share of height in y

    View(double azimuth_deg, double elevation_deg, double exaggeration) {
        double bearing = azimuth_deg - 90.0 * std::floor(azimuth_deg / 90.0);
        // Seen exactly along its direction a line would be a point: a twentieth of a degree is invisible but avoids
        // this.
        double const turned = std::clamp(bearing, 0.05, 89.95) - bearing;
        bearing = (azimuth_deg + turned) * degree;
        sine = std::sin(bearing);
        cosine = std::cos(bearing);
        tilt = std::sin(elevation_deg * degree);
        upright = exaggeration * std::cos(elevation_deg * degree);
    }

    Vec2 at(Vec2 ground, double z) const {
        return {ground.x * cosine - ground.y * sine, (ground.x * sine + ground.y * cosine) * tilt + z * upright};
    }
};

// The net over the terrain with its surroundings, projected.
struct Model {
    Fishnet knots;
    Net net;
    double exaggeration = 1.0;
    std::vector<std::array<Vec2, 2>> skirt;  // visible parts between knots on front edges and the base
    std::vector<std::array<Vec2, 2>> bottom; // the base between them
    Vec2 base_corner;                        // the nearest corner, on the base
    Vec2 base_col_end;                       // the far end of the front edge along columns
    Vec2 base_row_end;
    Box box; // of everything, y up: x, y are its lower left corner
};

// A position on the base below a knot.
struct Foot {
    Vec2 at;
    double depth = 0.0; // [m] of the knot, growing away from the viewer
};

using Feet = std::vector<Foot>;

/// Height of the terrain in front of a position, in its column of the sheet.
double cover_before(Net const& net, Feet const& feet, Foot const& place) {
    double cover = -std::numeric_limits<double>::infinity();
    auto const ask = [&](KnotId a, KnotId b) {
        Vec2 const from = net.at[a];
        Vec2 const to = net.at[b];
        double const share = (place.at.x - from.x) / (to.x - from.x);
        // Sides that end at the knot above hide nothing; between two knots the share is clearly inside.
        if (share > 1e-9 && share < 1.0 - 1e-9 && std::isfinite(from.y) && std::isfinite(to.y) &&
            feet[a].depth + (feet[b].depth - feet[a].depth) * share < place.depth - 1e-9 * std::fabs(place.depth)) {
            cover = std::max(cover, from.y + (to.y - from.y) * share);
        }
    };
    for (KnotId i = 0; i < std::ssize(net.at); ++i) {
        if ((i + 1) % net.columns != 0) {
            ask(i, i + 1);
        }
        if (i + net.columns < std::ssize(net.at)) {
            ask(i, i + net.columns);
        }
    }
    return cover;
}

// Adds a skirt to every side of a mesh with terrain behind it and none in front.
void hang_skirt(Model& model, Feet const& feet) {
    Net const& net = model.net;
    auto const has = [&](std::int64_t col, std::int64_t row) {
        return col >= 0 && row >= 0 && col < net.columns && row < net.rows && std::isfinite(net.knot(col, row).y);
    };
    auto const has_mesh = [&](std::int64_t col, std::int64_t row) { // by its knot of lowest column and row
        return has(col, row) && has(col + 1, row) && has(col, row + 1) && has(col + 1, row + 1);
    };
    std::vector<std::int8_t> hung(net.at.size(), 0); // 1: visible down to the base, 2: hidden there
    auto const hang = [&](std::int64_t col, std::int64_t row) {
        KnotId const knot = row * net.columns + col;
        if (hung[knot] == 0) {
            double const down_to = std::max(feet[knot].at.y, cover_before(net, feet, feet[knot]));
            Vec2 const top = net.at[knot];
            if (down_to < top.y) {
                model.skirt.push_back({top, Vec2{top.x, down_to}});
            }
            hung[knot] = down_to > feet[knot].at.y ? 2 : 1;
        }
        return hung[knot] == 1;
    };
    auto const hang_side = [&](std::int64_t col, std::int64_t row, std::int64_t next_col, std::int64_t next_row) {
        bool const first = hang(col, row);
        bool const second = hang(next_col, next_row);
        Foot const& from = feet[row * net.columns + col];
        Foot const& to = feet[next_row * net.columns + next_col];
        if (first && second) {
            model.bottom.push_back({from.at, to.at});
            return;
        }
        constexpr int parts = 12; // of a line that is partly hidden
        auto const at = [&](double share) {
            return Foot{{from.at.x + (to.at.x - from.at.x) * share, from.at.y + (to.at.y - from.at.y) * share},
                        from.depth + (to.depth - from.depth) * share};
        };
        for (int k = 0; k < parts; ++k) {
            Foot const middle = at((k + 0.5) / parts);
            if (cover_before(net, feet, middle) < middle.at.y) {
                model.bottom.push_back({at(static_cast<double>(k) / parts).at, at((k + 1.0) / parts).at});
            }
        }
    };
    for (std::int64_t row = 0; row < net.rows; ++row) {
        for (std::int64_t col = 0; col < net.columns; ++col) {
            std::int64_t const above = net.away_row > 0 ? row : row - 1; // the mesh behind a side along the row
            std::int64_t const before = net.away_row > 0 ? row - 1 : row;
            if (has_mesh(col, above) && !has_mesh(col, before)) {
                hang_side(col, row, col + 1, row);
            }
            std::int64_t const behind = net.away_col > 0 ? col : col - 1;
            std::int64_t const in_front = net.away_col > 0 ? col - 1 : col;
            if (has_mesh(behind, row) && !has_mesh(in_front, row)) {
                hang_side(col, row, col, row + 1);
            }
        }
    }
}

// The base is below the lowest knot by the larger of these.
constexpr double base_of_relief = 0.06;
constexpr double base_of_side = 0.015; ///< as drawn

/// Chooses an exaggeration that makes the relief about a fifth of the terrain's longer side: 1, 2, 3, 5 times a power
/// of ten, at least 1 unless the terrain is steeper than that.
double choose_exaggeration(double relief_m, double side_m) {
    if (!(relief_m > 0.0)) {
        return 1.0;
    }
    double const most = 0.22 * side_m / relief_m;
    if (most < 1.0 && most > 0.25) {
        return 1.0;
    }
    double const power = round_down(most) > 0.0 ? std::pow(10.0, std::floor(std::log10(most))) : 1.0;
    double chosen = power;
    for (double const factor : {2.0, 3.0, 5.0}) {
        chosen = factor * power <= most ? factor * power : chosen;
    }
    return std::clamp(chosen, 1e-6, 1e6);
}

Vec2 ground_of(Grid const& grid, double col, double row) {
    return {(col + 0.5) * grid.cell_m, -(row + 0.5) * grid.cell_m};
}

Net net_over(Fishnet const& knots, View const& view) {
    Net net;
    net.columns = knots.columns;
    net.rows = knots.rows;
    net.away_col = view.sine > 0.0 ? 1 : -1;
    net.away_row = view.cosine > 0.0 ? -1 : 1;
    return net;
}

Box box_around(std::vector<Vec2> const& places) {
    Vec2 least = places.front();
    Vec2 most = least;
    for (Vec2 const p : places) {
        if (std::isfinite(p.y)) {
            least = {std::min(least.x, p.x), std::min(least.y, p.y)};
            most = {std::max(most.x, p.x), std::max(most.y, p.y)};
        }
    }
    return {least.x, least.y, most.x - least.x, most.y - least.y};
}

// Builds the net, its skirt and their box, with the exaggeration of the params or a chosen one.
Model model_of(Raster<float> const& dem, WireframeParams const& params) {
    Model model;
    model.knots = fishnet(dem, params.lines);
    Fishnet const& knots = model.knots;
    bool const empty = knots.low_m > knots.high_m;
    double const low = empty ? 0.0 : knots.low_m;
    double const relief = empty ? 0.0 : knots.high_m - knots.low_m;
    double const side = dem.grid().cell_m * std::max(knots.col_at.back() - knots.col_at.front(),
                                                     knots.row_at.back() - knots.row_at.front());
    model.exaggeration = params.exaggeration > 0.0 ? params.exaggeration : choose_exaggeration(relief, side);
    View const view(params.azimuth_deg, params.elevation_deg, model.exaggeration);
    model.net = net_over(knots, view);
    Net& net = model.net;
    auto const place = [&](std::int64_t col, std::int64_t row) {
        return ground_of(dem.grid(), knots.col_at[col], knots.row_at[row]);
    };
    // Heights relative to the lowest: on a plateau the sheet would otherwise be far from the origin.
    double const base = -std::max(base_of_relief * relief, base_of_side * side / model.exaggeration);
    Feet feet;
    for (std::int64_t row = 0; row < net.rows; ++row) {
        for (std::int64_t col = 0; col < net.columns; ++col) {
            double const z = knots.height_m[row * net.columns + col];
            Vec2 const ground = place(col, row);
            net.at.push_back(view.at(ground, z - low));
            feet.push_back({view.at(ground, base), ground.x * view.sine + ground.y * view.cosine});
        }
    }
    hang_skirt(model, feet);

    std::int64_t const front_col = net.away_col > 0 ? 0 : net.columns - 1;
    std::int64_t const front_row = net.away_row > 0 ? 0 : net.rows - 1;
    std::int64_t const back_col = net.columns - 1 - front_col;
    std::int64_t const back_row = net.rows - 1 - front_row;
    model.base_corner = view.at(place(front_col, front_row), base);
    model.base_col_end = view.at(place(back_col, front_row), base);
    model.base_row_end = view.at(place(front_col, back_row), base);
    std::vector<Vec2> shown{model.base_corner, model.base_col_end, model.base_row_end,
                            view.at(place(back_col, back_row), base)};
    shown.insert(shown.end(), net.at.begin(), net.at.end());
    model.box = box_around(shown);
    return model;
}

constexpr int orders_shown = 3; // smaller streams would only hide the net
constexpr Colour skirt_line{0.55, 0.55, 0.57};
constexpr Colour river_line{0.08, 0.36, 0.72};

void require_scene(WireframeScene const& scene, WireframeParams const& params) {
    require_in("draw.wireframe", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    constexpr char const* stage = "draw.wireframe";
    require_in(stage, "azimuth_deg", params.azimuth_deg, Range::between(-36000.0, 36000.0));
    require_in(stage, "elevation_deg", params.elevation_deg, Range::between(5.0, 85.0));
    require_in(stage, "exaggeration", params.exaggeration, Range::between(0.0, 1e6));
    require_in(stage, "lines", params.lines, Range::between(2, 200));
    Grid const& grid = scene.dem.grid();
    refuse_if<BadInput>(grid.width < 1 || grid.height < 1 || !(grid.cell_m > 0.0) || !std::isfinite(grid.cell_m),
                        "draw.wireframe", "a DEM of {} x {} cells of {} m; draw one that has some", grid.width,
                        grid.height, grid.cell_m);
    if (scene.network != nullptr) {
        std::size_t const arcs = scene.network->planform.arc_count();
        if (scene.orders == nullptr || scene.orders->strahler.size() != arcs) {
            throw BadInput("draw.wireframe",
                           fmt::format("a network of {} arcs comes with {} orders; order this network", arcs,
                                       scene.orders == nullptr ? 0 : scene.orders->strahler.size()));
        }
    }
}

/// Rivers as threads on the net, with their order.
struct Rivers {
    std::vector<Thread> threads;
    std::vector<int> order;
    int highest = 0;
};

/// Position among ascending numbers, at whole numbers their indices; extrapolated beyond the ends.
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
    for (ArcId a = 0; a < scene.network->planform.arc_count(); ++a) {
        int const order = scene.orders->strahler[a];
        if (order <= rivers.highest - orders_shown) {
            continue;
        }
        Thread thread;
        for (Vec2 const p : scene.network->planform.arc(a).line) {
            Vec2 const at{index_of(knots.col_at, (p.x - grid.west) / grid.cell_m - 0.5),
                          index_of(knots.row_at, (grid.north - p.y) / grid.cell_m - 0.5)};
            // Vertices far off the net are not drawn, but would be cut at every line between.
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

/// "the south-west": the position of the viewer.
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

/// An arrow on the terrain that points north.
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

/// Layout of the model on the sheet; lengths in pixels.
struct Sheet {
    double width;
    double unit; ///< a pixel of a sheet 1200 px wide
    double margin;
    double top;
    double scale; ///< [px/m]
    double height;
    Vec2 corner; ///< the model's lower left corner

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

/// Traces a line of the hidden-line removal, whose y grows upwards.
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

/// Writes the length of a front edge beside it, if there is room.
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
        // Knots lie at cell centres: the terrain extends half a cell further.
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

Fishnet fishnet(Raster<float> const& dem, std::int64_t most_lines) {
    Extent const box = extent_of(dem);
    double const longer = static_cast<double>(std::max(box.east - box.west, box.south - box.north));
    double const apart = std::max(1.0, longer / static_cast<double>(most_lines - 1));
    Fishnet net;
    net.col_at = spread(box.west, box.east, apart);
    net.row_at = spread(box.north, box.south, apart);
    net.columns = std::ssize(net.col_at);
    net.rows = std::ssize(net.row_at);
    net.low_m = std::numeric_limits<double>::infinity();
    net.high_m = -net.low_m;
    // A third of a mesh each way: with less, single cells make the net noisy; with more, valleys fill up.
    double const reach = apart > 1.0 ? apart / 3.0 : 0.0;
    for (double const row : net.row_at) {
        for (double const col : net.col_at) {
            double const z = mean_around(dem, col, row, reach);
            net.height_m.push_back(z);
            if (std::isfinite(z)) {
                net.low_m = std::min(net.low_m, z);
                net.high_m = std::max(net.high_m, z);
            }
        }
    }
    return net;
}

double azimuth_up_valley(WireframeScene const& scene) {
    constexpr double standard = 30.0;
    if (scene.network == nullptr || scene.orders == nullptr) {
        return standard;
    }
    std::vector<Vec2> const stem = main_stem(scene.network->planform, *scene.orders).line;
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
    // Between edge-on and the diagonal, where squares would look like a chessboard.
    double const kept = std::copysign(std::clamp(std::fabs(off), 20.0, 35.0), off == 0.0 ? 1.0 : off);
    double const turned = axis + kept;
    return turned - 360.0 * std::floor(turned / 360.0);
}

Picture wireframe(WireframeScene const& scene, WireframeParams const& params) {
    require_scene(scene, params);
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
