// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/sections.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <cairo.h>
#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/map.hpp>
#include <thalweg/draw/internal/sections.hpp>

namespace thalweg::draw {

MainStem main_stem(StreamNetwork const& network, NetworkOrders const& orders) {
    MainStem stem;
    for (ArcId const arc : orders.main_stem) {
        std::vector<Vec2> const& line = network.arc(arc).line;
        bool const joins = !stem.line.empty() && !line.empty() && stem.line.back() == line.front();
        stem.line.insert(stem.line.end(), line.begin() + (joins ? 1 : 0), line.end());
    }
    std::reverse(stem.line.begin(), stem.line.end());
    stem.from_out_m.assign(stem.line.size(), 0.0);
    for (std::size_t i = 1; i < stem.line.size(); ++i) {
        stem.from_out_m[i] = stem.from_out_m[i - 1] + distance(stem.line[i - 1], stem.line[i]);
    }
    return stem;
}

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double most_points = 4000.0;

Vec2 place_on(MainStem const& stem, double from_out_m) {
    double const where = std::clamp(from_out_m, 0.0, stem.from_out_m.back());
    auto const after = std::lower_bound(stem.from_out_m.begin(), stem.from_out_m.end(), where);
    auto const k = static_cast<std::size_t>(after - stem.from_out_m.begin());
    if (k == 0) {
        return stem.line.front();
    }
    double const step = stem.from_out_m[k] - stem.from_out_m[k - 1];
    double const share = step > 0.0 ? (where - stem.from_out_m[k - 1]) / step : 0.0;
    Vec2 const a = stem.line[k - 1];
    Vec2 const b = stem.line[k];
    return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
}

/// The distance from a position in a direction to the border of the grid.
double room(Grid const& grid, Vec2 from, Vec2 along) {
    auto const until = [](double at, double step, double low, double high) {
        return step > 0.0   ? (high - at) / step
               : step < 0.0 ? (low - at) / step
                            : std::numeric_limits<double>::infinity();
    };
    return std::min(until(from.x, along.x, grid.west, grid.east()), until(from.y, along.y, grid.south(), grid.north));
}

void sample(Section& section, Raster<float> const& dem, double first, double last) {
    double const length = last - first;
    double const steps = std::clamp(std::ceil(length / dem.grid().cell_m), 1.0, most_points);
    for (double k = 0.0; k <= steps; k += 1.0) {
        double const share = k / steps;
        Vec2 const p{section.begin.x + (section.end.x - section.begin.x) * share,
                     section.begin.y + (section.end.y - section.begin.y) * share};
        section.points.push_back({first + length * share, height_at(dem, p)});
    }
}

std::vector<Section> through_the_middle(Raster<float> const& dem) {
    Grid const& grid = dem.grid();
    // Through cell centres, so that their heights are sampled.
    Vec2 const middle = grid.centre({grid.width / 2, grid.height / 2});
    Section row{Section::Kind::row, 0.0, {grid.west, middle.y}, {grid.east(), middle.y}, {}};
    Section column{Section::Kind::column, 0.0, {middle.x, grid.south()}, {middle.x, grid.north}, {}};
    sample(row, dem, 0.0, row.end.x - row.begin.x);
    sample(column, dem, 0.0, column.end.y - column.begin.y);
    return {std::move(row), std::move(column)};
}

constexpr Colour land_line{0.45, 0.28, 0.14};
constexpr Colour land{0.72, 0.56, 0.38, 0.22};
constexpr Colour water{0.08, 0.36, 0.72};
constexpr Colour grid_line{0.88, 0.88, 0.89};

std::string letter_of(std::size_t k) {
    return {static_cast<char>('A' + k)};
}

/// Scales common to all panels: x, and the span of y.
struct Scales {
    double x_low = 0.0;
    double x_high = 1.0;
    double span_m = 1.0;
    double step_m = 1.0;       ///< between the ticks of y
    int decimals = 0;          ///< of these
    std::vector<double> y_low; ///< by panel
};

Scales scales_of(std::vector<Section> const& sections, int ticks) {
    Scales scales;
    scales.x_low = std::numeric_limits<double>::infinity();
    scales.x_high = -scales.x_low;
    std::vector<Vec2> ranges;
    double greatest = 0.0;
    for (Section const& section : sections) {
        Vec2 range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        for (Vec2 const p : section.points) {
            scales.x_low = std::min(scales.x_low, p.x);
            scales.x_high = std::max(scales.x_high, p.x);
            if (std::isfinite(p.y)) {
                range = {std::min(range.x, p.y), std::max(range.y, p.y)};
            }
        }
        ranges.push_back(range.x <= range.y ? range : Vec2{0.0, 0.0});
        greatest = std::max(greatest, ranges.back().y - ranges.back().x);
    }
    bool const level = !(greatest > 0.0);
    greatest = level ? 1.0 : greatest;
    Ticks const marks = ticks_between(0.0, greatest, ticks);
    scales.step_m = marks.step;
    scales.decimals = decimals_of(marks.step);
    double const fifth = 0.2 * marks.step;
    double highest_share = 0.0;
    for (Vec2 const range : ranges) {
        // Leave some space below the lowest position: a line on the axis would be invisible.
        double const low = range.x - (level ? 0.5 : 0.03) * greatest;
        scales.y_low.push_back(std::floor(low / fifth + 1e-9) * fifth);
        highest_share = std::max(highest_share, range.y - scales.y_low.back());
    }
    scales.span_m = std::max(scales.step_m, std::ceil(1.02 * highest_share / fifth) * fifth);
    return scales;
}

std::string place_of(Section const& section) {
    switch (section.kind) {
    case Section::Kind::row: return "west to east, through the middle row";
    case Section::Kind::column: return "south to north, through the middle column";
    case Section::Kind::river: break;
    }
    double const m = section.from_outlet_m;
    return m >= 1000.0 ? number(m / 1000.0, m < 100000.0 ? 1 : 0) + " km from the outlet"
                       : number(m, m < 10.0 ? 1 : 0) + " m from the outlet";
}

/// Two significant digits: "3.2", "48", "1300".
std::string two_figures(double value) {
    double unit = 0.1;
    while (unit * 100.0 <= value && unit < 1e9) {
        unit *= 10.0;
    }
    return number(std::floor(value / unit + 0.5) * unit, unit < 1.0 ? 1 : 0);
}

/// The parts of a line between its gaps, on the sheet.
std::vector<std::vector<Vec2>> stretches_of(std::vector<Vec2> const& points, Plot const& plot) {
    std::vector<std::vector<Vec2>> out;
    bool open = false;
    for (Vec2 const p : points) {
        if (!std::isfinite(p.y)) {
            open = false;
            continue;
        }
        if (!open) {
            out.emplace_back();
        }
        out.back().push_back(plot.at(p.x, p.y));
        open = true;
    }
    return out;
}

Colour colour_of_layer(double strength) {
    constexpr Colour soft{0.95, 0.90, 0.78};
    constexpr Colour firm{0.58, 0.40, 0.26};
    constexpr double softest = 0.03;
    constexpr double firmest = 12.0;
    double const share = std::log(std::max(strength, softest) / softest) / std::log(firmest / softest);
    return mix(soft, firm, std::min(share, 1.0));
}

/// Fills the ground below a line by layers of rock, and draws their contacts.
class RockBelow {
public:
    RockBelow(Section const& section, LayersBelow const& below) : section_(section), layers_(below.layers) {
        double const first = section.points.front().x;
        double const length = section.points.back().x - first;
        for (Vec2 const p : section.points) {
            double const share = length > 0.0 ? (p.x - first) / length : 0.0;
            bed_.push_back(height_at(below.bed, {section.begin.x + (section.end.x - section.begin.x) * share,
                                                 section.begin.y + (section.end.y - section.begin.y) * share}));
        }
    }

    void draw(Cairo* sheet, Plot const& plot, double line_width) const {
        double bottom = -std::numeric_limits<double>::infinity();
        for (LayerBelow const& layer : layers_) {
            for (auto const& [begin, end] : runs()) {
                fill(sheet, plot, begin, end, bottom, layer);
            }
            bottom = layer.top_m;
        }
        for (LayerBelow const& layer : layers_) {
            draw_contact(sheet, plot, layer.top_m, line_width);
        }
    }

private:
    /// Points between gaps.
    std::vector<std::pair<std::size_t, std::size_t>> runs() const {
        std::vector<std::pair<std::size_t, std::size_t>> out;
        for (std::size_t k = 0; k < section_.points.size(); ++k) {
            if (!std::isfinite(section_.points[k].y + bed_[k])) {
                continue;
            }
            if (out.empty() || out.back().second != k) {
                out.emplace_back(k, k);
            }
            out.back().second = k + 1;
        }
        return out;
    }

    void fill(Cairo* sheet, Plot const& plot, std::size_t begin, std::size_t end, double bottom,
              LayerBelow const& layer) const {
        auto const height = [&](std::size_t k, double above_bed) {
            return std::clamp(bed_[k] + above_bed, plot.y_low, std::max(plot.y_low, section_.points[k].y));
        };
        bool is_seen = false;
        for (std::size_t k = begin; k < end; ++k) {
            is_seen = is_seen || height(k, layer.top_m) > height(k, bottom);
            Vec2 const at = plot.at(section_.points[k].x, height(k, layer.top_m));
            k == begin ? cairo_move_to(sheet, at.x, at.y) : cairo_line_to(sheet, at.x, at.y);
        }
        for (std::size_t k = end; k-- > begin;) {
            Vec2 const at = plot.at(section_.points[k].x, height(k, bottom));
            cairo_line_to(sheet, at.x, at.y);
        }
        cairo_close_path(sheet);
        if (!is_seen) {
            cairo_new_path(sheet);
            return;
        }
        set_colour(sheet, colour_of_layer(layer.strength));
        cairo_fill(sheet);
    }

    void draw_contact(Cairo* sheet, Plot const& plot, double top, double line_width) const {
        constexpr Colour contact{0.42, 0.30, 0.20, 0.6};
        bool is_drawing = false;
        for (std::size_t k = 0; k < section_.points.size(); ++k) {
            double const z = bed_[k] + top;
            Vec2 const p = section_.points[k];
            bool const is_below = std::isfinite(p.y) && z < p.y && z > plot.y_low;
            if (is_below) {
                Vec2 const at = plot.at(p.x, z);
                is_drawing ? cairo_line_to(sheet, at.x, at.y) : cairo_move_to(sheet, at.x, at.y);
            }
            is_drawing = is_below;
        }
        set_colour(sheet, contact);
        cairo_set_line_width(sheet, line_width);
        cairo_stroke(sheet);
    }

    Section const& section_;
    std::vector<LayerBelow> const& layers_;
    std::vector<double> bed_; ///< by point
};

void draw_panel(Cairo* sheet, Plot const& plot, Section const& section, LayersBelow const& below, Scales const& scales,
                std::size_t number_of, double unit) {
    Box const& box = plot.box;
    double const hair = 0.07 * unit;
    TextStyle const small{unit, faint_ink};
    double const first = std::ceil(plot.y_low / scales.step_m - 1e-9) * scales.step_m;
    for (double z = first; z <= plot.y_high + 1e-9 * scales.step_m; z += scales.step_m) {
        double const y = plot.at(plot.x_low, z).y;
        draw_line(sheet, {box.x, y}, {box.right(), y}, hair, grid_line);
        draw_line(sheet, {box.x - 0.35 * unit, y}, {box.x, y}, hair, faint_ink);
        draw_text(sheet, {box.x - 0.7 * unit, y + 0.36 * unit}, number(z, scales.decimals), small, Anchor::end);
    }
    std::vector<std::vector<Vec2>> const stretches = stretches_of(section.points, plot);
    bool const has_rock = below.bed.cells() > 0 && !section.points.empty();
    if (has_rock) {
        RockBelow(section, below).draw(sheet, plot, hair);
    }
    for (std::vector<Vec2> const& line : stretches) {
        draw_ground(sheet, line, box.bottom(), has_rock ? Colour{1.0, 1.0, 1.0, 0.0} : land, land_line, 0.13 * unit);
    }
    if (section.kind == Section::Kind::river) {
        // A mark at the river: a triangle on the terrain.
        auto const nearest = std::min_element(section.points.begin(), section.points.end(),
                                              [](Vec2 a, Vec2 b) { return std::fabs(a.x) < std::fabs(b.x); });
        if (nearest != section.points.end() && std::isfinite(nearest->y)) {
            Vec2 const at = plot.at(nearest->x, nearest->y);
            cairo_move_to(sheet, at.x, at.y - 0.15 * unit);
            cairo_line_to(sheet, at.x - 0.5 * unit, at.y - 1.0 * unit);
            cairo_line_to(sheet, at.x + 0.5 * unit, at.y - 1.0 * unit);
            cairo_close_path(sheet);
            set_colour(sheet, water);
            cairo_fill(sheet);
        }
    }
    draw_line(sheet, {box.x, box.bottom()}, {box.right(), box.bottom()}, 1.6 * hair, ink);
    draw_line(sheet, {box.x, box.y}, {box.x, box.bottom()}, 1.6 * hair, ink);
    TextStyle const bold{1.15 * unit, ink, Weight::bold, 0.25 * unit};
    std::string const letter = letter_of(number_of);
    double const base = box.y - 0.5 * unit;
    draw_text(sheet, {box.x, base}, letter, bold);
    draw_text_within(sheet, {box.x + text_width(sheet, letter, bold) + 0.7 * unit, base}, place_of(section),
                     {unit, ink, Weight::normal, 0.25 * unit}, box.width - 3.0 * unit);
    if (stretches.empty()) {
        draw_text(sheet, {box.x + 0.5 * box.width, box.y + 0.55 * box.height}, "no heights", small, Anchor::middle);
    }
}

/// Draws the key map of the sections: the DEM's frame, the main stem, and the lines with their letters.
void draw_key(Cairo* sheet, Box room, Grid const& grid, MainStem const& stem, std::vector<Section> const& sections,
              double unit) {
    double const wide = static_cast<double>(grid.width) * grid.cell_m;
    double const tall = static_cast<double>(grid.height) * grid.cell_m;
    Window window;
    window.px_per_m = std::min(room.width / wide, room.height / tall);
    window.frame = {room.x, room.y, wide * window.px_per_m, tall * window.px_per_m};
    window.frame.x += 0.5 * (room.width - window.frame.width);
    window.west = grid.west;
    window.north = grid.north;
    fill_box(sheet, window.frame, {0.96, 0.96, 0.95});
    cairo_save(sheet);
    cairo_rectangle(sheet, window.frame.x, window.frame.y, window.frame.width, window.frame.height);
    cairo_clip(sheet);
    if (!stem.line.empty()) {
        std::vector<Vec2> line(stem.line.size());
        std::transform(stem.line.begin(), stem.line.end(), line.begin(), [&](Vec2 p) { return window.at(p); });
        trace_line(sheet, line, 0.0);
        set_colour(sheet, water);
        cairo_set_line_width(sheet, 0.13 * unit);
        cairo_stroke(sheet);
    }
    cairo_restore(sheet);
    frame_box(sheet, window.frame, 0.08 * unit, faint_ink);
    TextStyle const letter{unit, ink, Weight::bold, 0.22 * unit};
    std::vector<Vec2> taken;
    auto const room_at = [&](Vec2 at) {
        double least = 1e9;
        for (Vec2 const other : taken) {
            least = std::min(least, distance(at, other));
        }
        return least;
    };
    for (std::size_t k = 0; k < sections.size(); ++k) {
        Vec2 const begin = window.at(sections[k].begin);
        Vec2 const end = window.at(sections[k].end);
        draw_line(sheet, begin, end, 0.11 * unit, ink);
        double const length = std::max(1e-9, distance(begin, end));
        Vec2 const off{(end.x - begin.x) / length * 0.8 * unit, (end.y - begin.y) / length * 0.8 * unit};
        Vec2 const at_begin = begin - off;
        Vec2 const at_end = end + off;
        bool const crowded = room_at(at_begin) < 1.4 * unit && room_at(at_end) > room_at(at_begin);
        taken.push_back(crowded ? at_end : at_begin);
        draw_text(sheet, {taken.back().x, taken.back().y + 0.36 * unit}, letter_of(k), letter, Anchor::middle);
    }
}

void draw_scale_of_x(Cairo* sheet, Box box, Ticks const& ticks, double metres_a_unit, Scales const& scales,
                     double unit) {
    Plot const plot{box, scales.x_low / metres_a_unit, scales.x_high / metres_a_unit, 0.0, 1.0};
    for (double const x : ticks.values) {
        double const px = plot.at(x, 0.0).x;
        draw_line(sheet, {px, box.bottom()}, {px, box.bottom() + 0.4 * unit}, 0.07 * unit, faint_ink);
        draw_text(sheet, {px, box.bottom() + 1.6 * unit}, number(x, ticks.decimals), {unit, faint_ink}, Anchor::middle);
    }
}

void require_sections(ElevatedNetwork const* network, NetworkOrders const* orders, SectionsParams const& params) {
    require_in("draw.sections", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_in("draw.sections", "count", params.count, Range::between(1, 9));
    if (network != nullptr && (orders == nullptr || orders->strahler.size() != network->planform.arc_count())) {
        throw BadInput("draw.sections",
                       fmt::format("a network of {} arcs comes with {} orders; order this network",
                                   network->planform.arc_count(), orders == nullptr ? 0 : orders->strahler.size()));
    }
}

/// Layout of the panels and their key; lengths in pixels.
struct PanelSheet {
    double width;
    double unit; ///< the size of a small letter
    double height;
    double pitch; ///< distance between panels
    double top;   ///< space above the first panel's name
    double below; ///< space below the last panel
    Box first;
    Box key;
    Scales scales;
    double metres_a_unit; ///< of the numbers along x
    double exaggeration;  ///< of heights
};

PanelSheet sheet_for_panels(std::vector<Section> const& cuts, double width) {
    PanelSheet sheet{};
    sheet.width = width;
    double const unit = 14.0 * std::max(0.45, width / 1000.0);
    sheet.unit = unit;
    double const left = 6.5 * unit;
    double const key_room = 0.24 * width;
    sheet.top = 3.6 * unit;
    sheet.below = 4.6 * unit;
    sheet.pitch = 12.8 * unit;
    sheet.height = std::ceil(sheet.top + static_cast<double>(cuts.size()) * sheet.pitch + sheet.below);
    double const gap = 2.2 * unit; // space above a panel for its name
    sheet.first = {left, sheet.top + gap, width - left - key_room - 4.5 * unit, sheet.pitch - gap};
    sheet.key = {width - key_room - 1.8 * unit, sheet.top + gap, key_room,
                 std::min(1.2 * key_room, sheet.height - sheet.top - gap - 8.0 * unit)};
    sheet.scales = scales_of(cuts, 4);
    Scales const& scales = sheet.scales;
    double const widest = std::max(std::fabs(scales.x_low), std::fabs(scales.x_high));
    sheet.metres_a_unit = widest >= 2000.0 ? 1000.0 : 1.0;
    double const px_per_m = sheet.first.width / std::max(scales.x_high - scales.x_low, 1e-300);
    sheet.exaggeration = sheet.first.height / scales.span_m / px_per_m;
    return sheet;
}

void draw_panels(Cairo* cairo, PanelSheet const& sheet, std::vector<Section> const& cuts, LayersBelow const& below) {
    Scales const& scales = sheet.scales;
    Ticks const ticks = ticks_between(scales.x_low / sheet.metres_a_unit, scales.x_high / sheet.metres_a_unit,
                                      std::clamp(static_cast<int>(sheet.first.width / (6.0 * sheet.unit)), 1, 8));
    for (std::size_t k = 0; k < cuts.size(); ++k) {
        Plot plot{sheet.first, scales.x_low, scales.x_high, scales.y_low[k], scales.y_low[k] + scales.span_m};
        plot.box.y += static_cast<double>(k) * sheet.pitch;
        for (double const x : ticks.values) {
            double const px = plot.at(x * sheet.metres_a_unit, plot.y_low).x;
            draw_line(cairo, {px, plot.box.y}, {px, plot.box.bottom()}, 0.07 * sheet.unit, grid_line);
        }
        draw_panel(cairo, plot, cuts[k], below, scales, k, sheet.unit);
        if (k + 1 == cuts.size()) {
            draw_scale_of_x(cairo, plot.box, ticks, sheet.metres_a_unit, scales, sheet.unit);
        }
    }
}

void name_axes(Cairo* cairo, PanelSheet const& sheet, bool across) {
    std::string const unit_name = sheet.metres_a_unit > 1.0 ? "[km]" : "[m]";
    TextStyle const axis{1.05 * sheet.unit, ink};
    draw_text_within(cairo, {sheet.first.x + 0.5 * sheet.first.width, sheet.height - sheet.below + 3.4 * sheet.unit},
                     (across ? "distance from the river " : "distance ") + unit_name +
                         (across ? ", looking downstream" : ""),
                     axis, sheet.first.width, Anchor::middle);
    draw_text(cairo, {1.6 * sheet.unit, sheet.top + 0.5 * (sheet.height - sheet.top - sheet.below)}, "height [m]", axis,
              Anchor::middle, Vec2{0.0, -1.0});
}

/// Writes the text common to all panels, below the key.
void write_scales(Cairo* cairo, PanelSheet const& sheet, Grid const& grid, bool has_rock) {
    Box const& key = sheet.key;
    double const high =
        std::min(key.height, key.width * static_cast<double>(grid.height) / static_cast<double>(grid.width));
    TextStyle const small{sheet.unit, faint_ink};
    draw_text_within(cairo, {key.x, key.y + high + 3.2 * sheet.unit}, "all panels on the same scales,", small,
                     key.width);
    draw_text_within(cairo, {key.x, key.y + high + 4.7 * sheet.unit}, "heights ×" + two_figures(sheet.exaggeration),
                     small, key.width);
    if (has_rock) {
        draw_text_within(cairo, {key.x, key.y + high + 6.2 * sheet.unit}, "dark: firm rock, pale: soft", small,
                         key.width);
    }
}

} // namespace

std::string layer_colour(double strength) {
    Colour const colour = colour_of_layer(strength);
    auto const of_256 = [](double part) { return static_cast<int>(std::lround(255.0 * part)); };
    return fmt::format("#{:02x}{:02x}{:02x}", of_256(colour.red), of_256(colour.green), of_256(colour.blue));
}

double height_at(Raster<float> const& dem, Vec2 position) {
    Grid const& grid = dem.grid();
    // Ends of a section lie on the border up to rounding.
    double const edge = 0.5 + 1e-6;
    double const col = (position.x - grid.west) / grid.cell_m - 0.5;
    double const row = (grid.north - position.y) / grid.cell_m - 0.5;
    if (!(col >= -edge && row >= -edge && col <= static_cast<double>(grid.width) - 1.0 + edge &&
          row <= static_cast<double>(grid.height) - 1.0 + edge)) {
        return nothing;
    }
    double const c = std::clamp(col, 0.0, static_cast<double>(grid.width - 1));
    double const r = std::clamp(row, 0.0, static_cast<double>(grid.height - 1));
    auto const c0 = static_cast<std::int64_t>(c);
    auto const r0 = static_cast<std::int64_t>(r);
    double const x = c - static_cast<double>(c0);
    double const y = r - static_cast<double>(r0);
    double sum = 0.0;
    for (auto const& [dc, dr, weight] : {std::tuple{0, 0, (1.0 - x) * (1.0 - y)}, std::tuple{1, 0, x * (1.0 - y)},
                                         std::tuple{0, 1, (1.0 - x) * y}, std::tuple{1, 1, x * y}}) {
        if (weight > 0.0) {
            float const z = dem[Cell{c0 + dc, r0 + dr}];
            sum += std::isfinite(z) ? weight * static_cast<double>(z) : nothing;
        }
    }
    return sum;
}

std::vector<Section> cut_sections(Raster<float> const& dem, ElevatedNetwork const* network, NetworkOrders const* orders,
                                  int count) {
    Grid const& grid = dem.grid();
    refuse_if<BadInput>(grid.width < 1 || grid.height < 1 || !(grid.cell_m > 0.0), "draw.cut_sections",
                        "a DEM of {} x {} cells of {} m; take one that has some", grid.width, grid.height, grid.cell_m);
    MainStem const stem = network == nullptr || orders == nullptr ? MainStem{} : main_stem(network->planform, *orders);
    if (stem.line.size() < 2 || !(stem.from_out_m.back() > 0.0)) {
        return through_the_middle(dem);
    }
    double const length = stem.from_out_m.back();
    // The course over a stretch of the river: a single step between cells does not show the direction of the valley.
    double const stretch = std::max(0.06 * length, 4.0 * grid.cell_m);
    double const reach = std::max(0.18 * length, 12.0 * grid.cell_m);
    std::vector<Section> sections;
    for (int k = 0; k < count; ++k) {
        double const where = length * (count == 1 ? 0.5 : 0.9 - 0.8 * k / (count - 1));
        Vec2 const at = place_on(stem, where);
        Vec2 const above = place_on(stem, where + stretch);
        Vec2 const below = place_on(stem, where - stretch);
        double const course = distance(above, below);
        Vec2 const down =
            course > 0.0 ? Vec2{(below.x - above.x) / course, (below.y - above.y) / course} : Vec2{0.0, -1.0};
        Vec2 const right{down.y, -down.x};
        double const left_reach = std::min(reach, room(grid, at, {-right.x, -right.y}));
        double const right_reach = std::min(reach, room(grid, at, right));
        if (!(left_reach >= 0.0 && right_reach >= 0.0 && left_reach + right_reach > 0.0)) {
            continue; // the river is off the DEM here
        }
        Section section;
        section.from_outlet_m = where;
        section.begin = {at.x - right.x * left_reach, at.y - right.y * left_reach};
        section.end = {at.x + right.x * right_reach, at.y + right.y * right_reach};
        sample(section, dem, -left_reach, right_reach);
        sections.push_back(std::move(section));
    }
    return sections.empty() ? through_the_middle(dem) : sections;
}

Picture sections(Raster<float> const& dem, ElevatedNetwork const* network, NetworkOrders const* orders,
                 SectionsParams const& params) {
    require_sections(network, orders, params);
    if (params.below.bed.cells() > 0) {
        require_same_grid(dem.grid(), params.below.bed.grid(), "draw.sections", "the DEM and the bed of the layers",
                          "make both on one grid");
    }
    std::vector<Section> const cuts = cut_sections(dem, network, orders, params.count);
    bool const across = cuts.front().kind == Section::Kind::river;
    MainStem const stem = across ? main_stem(network->planform, *orders) : MainStem{};
    PanelSheet const sheet = sheet_for_panels(cuts, params.width_px);
    return paint(sheet.width, sheet.height, params.format, [&](Cairo* cairo) {
        std::string const name = across ? "Cross-sections" : "Sections";
        draw_text_within(cairo, {sheet.first.x, 2.2 * sheet.unit},
                         params.title.empty() ? name : params.title + ": " + (across ? "cross-sections" : "sections"),
                         {1.35 * sheet.unit, ink, Weight::bold}, sheet.width - sheet.first.x - 2.0 * sheet.unit);
        draw_panels(cairo, sheet, cuts, params.below);
        name_axes(cairo, sheet, across);
        draw_key(cairo, sheet.key, dem.grid(), stem, cuts, sheet.unit);
        write_scales(cairo, sheet, dem.grid(), params.below.bed.cells() > 0);
    });
}

} // namespace thalweg::draw
