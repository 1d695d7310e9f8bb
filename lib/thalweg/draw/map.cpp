// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/draw/map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include <cairo.h>
#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/internal/labels.hpp>
#include <thalweg/draw/internal/map.hpp>
#include <thalweg/draw/internal/water.hpp>

namespace thalweg::draw {
namespace {

constexpr Colour link_colour{0.05, 0.28, 0.58};

struct LinesBox {
    Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
};

LinesBox box_of_lines(std::vector<std::vector<Vec2>> const& lines) {
    LinesBox all;
    for (auto const& line : lines) {
        for (Vec2 const p : line) {
            refuse_if<BadInput>(!is_finite(p), "draw.lines", "a line has a coordinate that is not finite");
            all.low = {std::min(all.low.x, p.x), std::min(all.low.y, p.y)};
            all.high = {std::max(all.high.x, p.x), std::max(all.high.y, p.y)};
        }
    }
    return all;
}

/// Sage, straw, sand, clay, white: seven colours interpolated in OKLab and divided into equal lengths there, so that
/// equal differences of height look equally large. Light enough for shading.
constexpr std::array<std::array<double, 3>, 17> tints = {{{126, 166, 136},
                                                          {137, 173, 140},
                                                          {148, 181, 143},
                                                          {159, 189, 147},
                                                          {170, 196, 150},
                                                          {185, 202, 155},
                                                          {199, 208, 159},
                                                          {214, 214, 164},
                                                          {231, 210, 166},
                                                          {227, 201, 162},
                                                          {222, 193, 160},
                                                          {225, 201, 177},
                                                          {228, 209, 194},
                                                          {233, 218, 207},
                                                          {238, 227, 219},
                                                          {243, 237, 231},
                                                          {248, 246, 243}}};

constexpr int level_shade = 181; ///< GDAL's hillshade of level ground under a light 45 degrees high

/// Slopes turned away from the light are multiplied by a cool grey, those facing it are lightened.
Colour shade(Colour ground, double light) {
    if (light <= 0.0) {
        return mix(ground, {ground.red * 0.30, ground.green * 0.33, ground.blue * 0.45}, -light);
    }
    return mix(ground, {1.0, 1.0, 0.96}, 0.55 * light);
}

/// Light for every hillshade value, [-1, 1], 0: level; stretched for faint relief.
std::array<double, 256> lights(Raster<float> const& dem, Raster<std::uint8_t> const& hillshade) {
    std::array<std::int64_t, 256> count{};
    std::int64_t all = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isfinite(dem[i]) && hillshade[i] > 0) {
            ++count[hillshade[i]];
            ++all;
        }
    }
    std::size_t darkest = 1; // except for one cell in fifty
    for (std::int64_t below = count[1]; darkest < level_shade && below * 50 < all;) {
        below += count[++darkest];
    }
    double const depth = std::max(1.0, static_cast<double>(level_shade) - static_cast<double>(darkest));
    double const gain = std::clamp(130.0 / depth, 1.0, 2.5);
    std::array<double, 256> light{};
    for (std::size_t s = 1; s < 256; ++s) {
        double const off = gain * (static_cast<double>(s) - level_shade);
        light[s] = std::clamp(off < 0.0 ? off / 180.0 : off / 74.0, -1.0, 1.0);
    }
    return light;
}

/// Colours cells by height and light.
class Ground {
public:
    Ground(Raster<float> const& dem, Raster<std::uint8_t> const& hillshade, HeightRange const& heights, bool has_sea,
           double shading)
        : dem_(dem), hillshade_(hillshade), light_(lights(dem, hillshade)), low_m_(heights.low_m),
          span_m_(heights.high_m - heights.low_m), has_sea_(has_sea) {
        for (double& light : light_) {
            light *= shading;
        }
    }

    /// \return alpha 0: not coloured. In the sea, cells near land have the mean colour of the land around them: shores
    /// are smoother than cells.
    Colour at(Cell c) const {
        if (std::isfinite(dem_[c])) {
            return seen(c);
        }
        Colour sum{0.0, 0.0, 0.0, 0.0};
        for (std::int64_t row = c.row - 2; has_sea_ && row <= c.row + 2; ++row) {
            for (std::int64_t col = c.col - 2; col <= c.col + 2; ++col) {
                if (dem_.grid().contains({col, row}) && std::isfinite(dem_[Cell{col, row}])) {
                    Colour const land = seen({col, row});
                    sum = {sum.red + land.red, sum.green + land.green, sum.blue + land.blue, sum.alpha + 1.0};
                }
            }
        }
        double const lands = std::max(sum.alpha, 1.0);
        return {sum.red / lands, sum.green / lands, sum.blue / lands, std::min(sum.alpha, 1.0)};
    }

private:
    Colour seen(Cell c) const {
        double const z = dem_[c];
        return shade(tint(span_m_ > 0.0 ? (z - low_m_) / span_m_ : 0.4), light_[hillshade_[c]]);
    }

    Raster<float> const& dem_;
    Raster<std::uint8_t> const& hillshade_;
    std::array<double, 256> light_;
    double low_m_;
    double span_m_;
    bool has_sea_;
};

// Makes the background of a map: the sheet's heights and their hillshade [1, 255] (0: none).
// Returns one pixel per cell, or one for the mean colour of every k × k cells, with the largest k that leaves at least
// most_wide pixels in a row; k is larger if the picture would exceed 30 000 pixels a side.
// shading: [0, 1] share of light and shade.
Relief tinted_relief(MapSheet const& sheet, HeightRange const& heights, double most_wide, double shading = 1.0) {
    Raster<float> const& dem = sheet.dem;
    Relief relief;
    Ground const ground(dem, sheet.hillshade, heights, sheet.sea.has_value(), shading);

    constexpr std::int64_t longest = 30000;
    std::int64_t const fine = static_cast<std::int64_t>(static_cast<double>(dem.width()) / std::max(1.0, most_wide));
    std::int64_t const block = std::max(
        {std::int64_t{1}, fine, (dem.width() + longest - 1) / longest, (dem.height() + longest - 1) / longest});
    std::int64_t const columns = (dem.width() + block - 1) / block;
    std::int64_t const rows = (dem.height() + block - 1) / block;
    relief.width = static_cast<int>(columns);
    relief.height = static_cast<int>(rows);
    relief.cells_a_pixel = static_cast<double>(block);
    relief.pixels.reserve(static_cast<std::size_t>(columns * rows));
    for (std::int64_t r = 0; r < rows; ++r) {
        for (std::int64_t c = 0; c < columns; ++c) {
            Colour sum{0.0, 0.0, 0.0, 0.0};
            std::int64_t const right = std::min(dem.width(), (c + 1) * block);
            std::int64_t const bottom = std::min(dem.height(), (r + 1) * block);
            for (std::int64_t row = r * block; row < bottom; ++row) {
                for (std::int64_t col = c * block; col < right; ++col) {
                    Colour const seen = ground.at({col, row});
                    sum = {sum.red + seen.red, sum.green + seen.green, sum.blue + seen.blue, sum.alpha + seen.alpha};
                }
            }
            double const cells = static_cast<double>((right - c * block) * (bottom - r * block));
            relief.pixels.push_back(packed(sum.red / cells, sum.green / cells, sum.blue / cells, sum.alpha / cells));
        }
    }
    return relief;
}

bool has_lakes(MapSheet const& sheet) {
    return sheet.lakes != nullptr && sheet.lakes->cells() > 0;
}

/// Formats that can be scaled have two pixels for one.
double density_of(Format format) {
    return format == Format::png ? 1.0 : 2.0;
}

void require_finite(std::vector<Vec2> const& line, char const* what, std::size_t number_of_line) {
    for (std::size_t i = 0; i < line.size(); ++i) {
        refuse_if<BadInput>(!is_finite(line[i]), "draw.map",
                            "{} {}, vertex {} has no finite coordinates; mend the line", what, number_of_line, i);
    }
}

void require_sheet(MapSheet const& sheet, MapParams const& params) {
    require_in("draw.map", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_in("draw.map", "contour_interval_m", params.contour_interval_m, Range::at_least(0.0));
    Grid const& grid = sheet.dem.grid();
    refuse_if<BadInput>(grid.width < 1 || grid.height < 1, "draw.map",
                        "the DEM has {} x {} cells; draw one that has some", grid.width, grid.height);
    refuse_if<BadInput>(!(grid.cell_m > 0.0) || !std::isfinite(grid.east()) || !std::isfinite(grid.south()), "draw.map",
                        "the grid's cell of {} m or its origin ({}, {}) is not usable; mend its georeference",
                        grid.cell_m, grid.west, grid.north);
    refuse_if<BadInput>(sheet.orders != nullptr && sheet.network == nullptr, "draw.map",
                        "orders without the network that they are of");
    refuse_if<BadInput>(sheet.hillshade.width() != grid.width || sheet.hillshade.height() != grid.height, "draw.map",
                        "the hillshade has {} x {} cells, the DEM {} x {}; shade this DEM", sheet.hillshade.width(),
                        sheet.hillshade.height(), grid.width, grid.height);
    if (has_lakes(sheet)) {
        refuse_if<BadInput>(sheet.lakes->width() != grid.width || sheet.lakes->height() != grid.height, "draw.map",
                            "the lakes have {} x {} cells, the DEM {} x {}; give lakes of this DEM",
                            sheet.lakes->width(), sheet.lakes->height(), grid.width, grid.height);
    }
    for (std::size_t i = 0; i < sheet.spot_heights.size(); ++i) {
        SpotHeight const& spot = sheet.spot_heights[i];
        refuse_if<BadInput>(!is_finite(spot.at) || !std::isfinite(spot.z), "draw.map",
                            "spot height {} is not finite; mend it", i + 1);
    }
    for (std::size_t i = 0; i < sheet.contours.size(); ++i) {
        require_finite(sheet.contours[i].second, "contour", i);
    }
    if (has_ridges(sheet)) {
        for (std::size_t i = 0; i < sheet.ridges->lines.size(); ++i) {
            require_finite(in_plan(sheet.ridges->lines[i].line), "ridge", i + 1);
        }
    }
    if (sheet.network == nullptr) {
        return;
    }
    std::size_t const arcs = sheet.network->planform.arc_count();
    if (sheet.orders == nullptr || sheet.orders->strahler.size() != arcs) {
        throw BadInput("draw.map", fmt::format("a network of {} arcs comes with {} orders; order this network", arcs,
                                               sheet.orders == nullptr ? 0 : sheet.orders->strahler.size()));
    }
    refuse_if<BadInput>(!sheet.areas_m2.empty() && sheet.areas_m2.size() != arcs, "draw.map",
                        "a network of {} arcs comes with {} areas; measure the areas of this network", arcs,
                        sheet.areas_m2.size());
    for (ArcId a = 0; a < arcs; ++a) {
        require_finite(sheet.network->planform.arc(a).line, "arc", a + 1);
    }
}

/// "EPSG:…" unchanged; of WKT the name.
std::string name_of_crs(std::string const& crs) {
    std::size_t const open = crs.find('"');
    std::size_t const close = open == std::string::npos ? open : crs.find('"', open + 1);
    return crs.empty() ? "no CRS" : close == std::string::npos ? crs : crs.substr(open + 1, close - open - 1);
}

/// A height as the report page writes it.
std::string height_in_words(double z, HeightRange const& heights) {
    return figures(heights.high_m - heights.low_m >= 50.0 ? std::floor(z + 0.5) : z, 5);
}

/// The line below the title, in the words of the report page.
std::vector<std::string> facts_of(MapSheet const& sheet, MapParams const& params, HeightRange const& heights) {
    Grid const& grid = whole_grid(sheet);
    auto const cells = [](std::int64_t count) { return figures(static_cast<double>(count), 7); };
    auto const km = [&](std::int64_t count) { return figures(static_cast<double>(count) * grid.cell_m / 1000.0, 3); };
    std::vector<std::string> facts = {fmt::format("{} × {} cells of {} m ({} × {} km)", cells(grid.width),
                                                  cells(grid.height), figures(grid.cell_m, 4), km(grid.width),
                                                  km(grid.height)),
                                      params.crs.empty() ? name_of_crs(grid.crs) : params.crs};
    if (int const highest = river_scale(sheet).highest_order; highest > 0) {
        std::size_t const arcs = sheet.network->planform.arc_count();
        facts.push_back(fmt::format("{} {} to order {}", figures(static_cast<double>(arcs), 4),
                                    arcs == 1 ? "arc" : "arcs", highest));
    }
    if (heights.low_m <= heights.high_m) {
        facts.push_back(fmt::format("{} to {} m", height_in_words(heights.low_m, heights),
                                    height_in_words(heights.high_m, heights)));
    }
    if (!params.remark.empty()) {
        facts.push_back(params.remark);
    }
    return facts;
}

/// How the sheet is laid out [px].
struct Layout {
    double unit = 1.0; ///< equivalent of 1 px on a sheet 1400 px wide
    double band = 0.0; ///< between the map and its outer frame: the coordinates
    Window window;
    Box ground; ///< of the DEM
    double width = 0.0;
    double height = 0.0;
    std::vector<std::string> facts; ///< lines below the title
    LegendFacts legend;
    Vec2 legend_corner;
    double legend_width = 0.0;
};

constexpr double facts_pitch = 20.0; ///< [units] between base lines

TextStyle facts_style(double unit) {
    return {14.5 * unit, faint_ink};
}

double unit_of(int width_px) {
    return std::max(0.6, width_px / 1400.0);
}

constexpr double margin_units = 22.0;
constexpr double band_units = 23.0;

/// \param room [px] width inside the frame
double px_per_m_of(Grid const& grid, double room) {
    double const ground_wide = static_cast<double>(grid.width) * grid.cell_m;
    double const ground_tall = static_cast<double>(grid.height) * grid.cell_m;
    return std::min(room / ground_wide, 1.4 * room / ground_tall);
}

double room_of(int width_px) {
    return width_px - 2.0 * (margin_units + band_units) * unit_of(width_px);
}

Layout lay_out(MapSheet const& sheet, MapParams const& params, std::vector<std::string> const& facts) {
    Grid const& grid = whole_grid(sheet);
    Layout out;
    out.width = params.width_px;
    out.unit = unit_of(params.width_px);
    out.band = band_units * out.unit;
    double const room = room_of(params.width_px);
    out.facts = lines_within(facts, facts_style(out.unit), out.width - 44.0 * out.unit);
    double const top = (params.title.empty() ? 22.0 : 60.0) * out.unit +
                       static_cast<double>(out.facts.size()) * facts_pitch * out.unit + out.band;
    out.window.px_per_m = px_per_m_of(grid, room);
    out.ground.width = static_cast<double>(grid.width) * grid.cell_m * out.window.px_per_m;
    out.ground.height = static_cast<double>(grid.height) * grid.cell_m * out.window.px_per_m;
    // The frame around a single row or column of cells must remain visible.
    double const least = std::min(60.0 * out.unit, room);
    Box& frame = out.window.frame;
    frame.width = std::max(out.ground.width, least);
    frame.height = std::floor(std::max(out.ground.height, least) + 0.5);
    frame.x = 0.5 * (out.width - frame.width);
    frame.y = top;
    out.ground.x = frame.x + 0.5 * (frame.width - out.ground.width);
    out.ground.y = frame.y + 0.5 * (frame.height - out.ground.height);
    out.window.west = grid.west - (out.ground.x - frame.x) / out.window.px_per_m;
    out.window.north = grid.north + (out.ground.y - frame.y) / out.window.px_per_m;
    out.legend_corner = {22.0 * out.unit, frame.bottom() + out.band + 20.0 * out.unit};
    out.legend_width = out.width - 44.0 * out.unit;
    out.legend.px_per_m = out.window.px_per_m;
    out.legend.ground_px = out.ground.width;
    out.legend.rivers = river_scale(sheet);
    out.legend.contour_interval_m = params.contour_interval_m;
    out.legend.ridges = has_ridges(sheet);
    return out;
}

/// The coordinates of one side in the band, with ticks from the inner frame.
struct Side {
    Vec2 from; ///< [px] on the inner frame at the low end of the coordinates
    Vec2 to;   ///< at the high end
    Vec2 outward;
};

void draw_side(Cairo* canvas, Side const& side, Ticks const& ticks, double low, double high, double unit) {
    TextStyle const style{12.0 * unit, ink};
    bool const upright = side.outward.x != 0.0; // numbers beside the map read upwards
    double const length = distance(side.from, side.to);
    for (double const value : ticks.values) {
        double const share = (value - low) / (high - low);
        Vec2 const at{side.from.x + (side.to.x - side.from.x) * share, side.from.y + (side.to.y - side.from.y) * share};
        draw_line(canvas, at, {at.x + side.outward.x * 5.0 * unit, at.y + side.outward.y * 5.0 * unit}, unit, ink);
        std::string const label = number(value, ticks.decimals);
        double const half = 0.5 * text_width(canvas, label, style);
        if (share * length < half || (1.0 - share) * length < half) {
            continue; // would be in the corner
        }
        double const middle = 14.0 * unit;
        double const base = 4.3 * unit; // from the middle of a digit to its base line
        Vec2 const place{at.x + side.outward.x * middle + (upright ? base : 0.0),
                         at.y + side.outward.y * middle + (upright ? 0.0 : base)};
        draw_text(canvas, place, label, style, Anchor::middle, upright ? Vec2{0.0, -1.0} : Vec2{1.0, 0.0});
    }
}

void draw_frame(Cairo* canvas, Layout const& layout) {
    Window const& window = layout.window;
    Box const& frame = window.frame;
    double const unit = layout.unit;
    double const low_x = window.west / 1000.0;
    double const high_x = window.east() / 1000.0;
    double const low_y = window.south() / 1000.0;
    double const high_y = window.north / 1000.0;
    auto const most = [&](double pixels) { return std::clamp(static_cast<int>(pixels / (130.0 * unit)), 1, 10); };
    // One step for both axes: the crosses form squares.
    double const step = std::max(ticks_between(low_x, high_x, most(frame.width)).step,
                                 ticks_between(low_y, high_y, most(frame.height)).step);
    auto const by_step = [&](double low, double high, double pixels) {
        Ticks const own = ticks_between(low, high, most(pixels));
        Ticks shared = ticks_between(low, high, std::max(1, static_cast<int>((high - low) / step + 0.5)));
        return shared.values.size() >= 2 && shared.values.size() <= own.values.size() ? shared : own;
    };
    Ticks const x_ticks = by_step(low_x, high_x, frame.width);
    Ticks const y_ticks = by_step(low_y, high_y, frame.height);

    for (double const x : x_ticks.values) {
        for (double const y : y_ticks.values) {
            Vec2 const at = window.at({1000.0 * x, 1000.0 * y});
            double const arm = 5.0 * unit;
            draw_line(canvas, {at.x - arm, at.y}, {at.x + arm, at.y}, 0.8 * unit, {0.1, 0.1, 0.1, 0.55});
            draw_line(canvas, {at.x, at.y - arm}, {at.x, at.y + arm}, 0.8 * unit, {0.1, 0.1, 0.1, 0.55});
        }
    }
    Box const outer{frame.x - layout.band, frame.y - layout.band, frame.width + 2.0 * layout.band,
                    frame.height + 2.0 * layout.band};
    frame_box(canvas, frame, 1.0 * unit, ink);
    frame_box(canvas, outer, 2.0 * unit, ink);
    draw_side(canvas, {{frame.x, frame.bottom()}, {frame.right(), frame.bottom()}, {0.0, 1.0}}, x_ticks, low_x, high_x,
              unit);
    draw_side(canvas, {{frame.x, frame.y}, {frame.right(), frame.y}, {0.0, -1.0}}, x_ticks, low_x, high_x, unit);
    draw_side(canvas, {{frame.x, frame.bottom()}, {frame.x, frame.y}, {-1.0, 0.0}}, y_ticks, low_y, high_y, unit);
    draw_side(canvas, {{frame.right(), frame.bottom()}, {frame.right(), frame.y}, {1.0, 0.0}}, y_ticks, low_y, high_y,
              unit);
    draw_text(canvas, {outer.x + 0.5 * layout.band, frame.bottom() + 0.68 * layout.band}, "km",
              {10.0 * unit, faint_ink}, Anchor::middle);
}

void draw_heading(Cairo* canvas, Layout const& layout, std::string const& title) {
    double const unit = layout.unit;
    double const left = 22.0 * unit;
    double const room = layout.width - 2.0 * left;
    draw_text_within(canvas, {left, 44.0 * unit}, title, {26.0 * unit, ink, Weight::bold}, room);
    double y = (title.empty() ? 33.0 : 70.0) * unit;
    for (std::string const& line : layout.facts) {
        draw_text_within(canvas, {left, y}, line, facts_style(unit), room);
        y += facts_pitch * unit;
    }
}

} // namespace

Picture lines(std::vector<std::vector<Vec2>> const& lines, LinesParams const& params) {
    require_in("draw.lines", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_in("draw.lines", "height_px", params.height_px, Range::between(200, 8000), "pixels");
    double const width = params.width_px;
    double const height = params.height_px;
    double const unit = 0.014 * std::min(width, height);
    double const top = params.title.empty() ? 2.0 * unit : 4.2 * unit;
    Box const box{2.0 * unit, top, width - 4.0 * unit, height - top - 2.0 * unit};
    LinesBox const all = box_of_lines(lines);
    double const span_x = std::max(all.high.x - all.low.x, 1e-9);
    double const span_y = std::max(all.high.y - all.low.y, 1e-9);
    double const scale = std::min(box.width / span_x, box.height / span_y);
    double const left = box.x + 0.5 * (box.width - scale * span_x);
    double const bottom = box.bottom() - 0.5 * (box.height - scale * span_y);
    return paint(width, height, params.format, [&](Cairo* sheet) {
        if (!params.title.empty()) {
            draw_text_within(sheet, {box.x, 2.4 * unit}, params.title, {1.35 * unit, ink, Weight::bold}, box.width);
        }
        set_colour(sheet, link_colour);
        cairo_set_line_width(sheet, std::clamp(0.12 * scale, 0.4, 2.0));
        cairo_set_line_cap(sheet, CAIRO_LINE_CAP_ROUND);
        cairo_set_line_join(sheet, CAIRO_LINE_JOIN_ROUND);
        for (auto const& line : lines) {
            std::vector<Vec2> drawn;
            for (Vec2 const p : line) {
                drawn.push_back({left + scale * (p.x - all.low.x), bottom - scale * (p.y - all.low.y)});
            }
            trace_line(sheet, drawn, 0.0);
            cairo_stroke(sheet);
        }
    });
}

std::vector<std::string> tint_colours() {
    std::vector<std::string> codes;
    for (auto const& [red, green, blue] : tints) {
        codes.push_back(
            fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(red), static_cast<int>(green), static_cast<int>(blue)));
    }
    return codes;
}

Colour mix(Colour a, Colour b, double share) {
    auto const blend = [share](double p, double q) { return p + (q - p) * share; };
    return {blend(a.red, b.red), blend(a.green, b.green), blend(a.blue, b.blue), 1.0};
}

std::uint32_t packed(double red, double green, double blue, double alpha) {
    auto const byte = [](double v) { return static_cast<std::uint32_t>(std::clamp(v, 0.0, 1.0) * 255.0 + 0.5); };
    return byte(alpha) << 24U | byte(red) << 16U | byte(green) << 8U | byte(blue);
}

Colour tint(double share) {
    double const place = std::clamp(share, 0.0, 1.0) * static_cast<double>(tints.size() - 1);
    std::size_t const k = std::min(static_cast<std::size_t>(place), tints.size() - 2);
    double const part = place - static_cast<double>(k);
    auto const channel = [&](std::size_t c) { return (tints[k][c] + (tints[k + 1][c] - tints[k][c]) * part) / 255.0; };
    return {channel(0), channel(1), channel(2), 1.0};
}

HeightRange height_range(Raster<float> const& dem) {
    HeightRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (float const z : dem.values()) {
        if (std::isfinite(z)) {
            range.low_m = std::min(range.low_m, static_cast<double>(z));
            range.high_m = std::max(range.high_m, static_cast<double>(z));
        } else {
            ++range.holes;
        }
    }
    return range;
}

HeightRange height_range(MapSheet const& sheet) {
    HeightRange range = height_range(sheet.dem);
    if (sheet.whole) {
        range.low_m = sheet.whole->low_m;
        range.high_m = sheet.whole->high_m;
    }
    return range;
}

std::int64_t columns_of_map(Grid const& grid, MapParams const& params) {
    double const ground_wide = static_cast<double>(grid.width) * grid.cell_m;
    double const pixels = density_of(params.format) * ground_wide * px_per_m_of(grid, room_of(params.width_px));
    return static_cast<std::int64_t>(std::ceil(pixels - 1e-6));
}

std::int64_t columns_of_ground(Grid const& grid, GroundParams const& params) {
    double const px_per_cell = static_cast<double>(params.width_px) / static_cast<double>(grid.width - 1);
    return static_cast<std::int64_t>(std::ceil(px_per_cell * static_cast<double>(grid.width) - 1e-6));
}

void draw_relief(Cairo* sheet, Relief const& relief, Box where, double px_per_cell) {
    struct End {
        void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    };
    auto* const pixels = const_cast<std::uint32_t*>(relief.pixels.data()); // Cairo only reads a source
    std::unique_ptr<cairo_surface_t, End> const image(cairo_image_surface_create_for_data(
        reinterpret_cast<unsigned char*>(pixels), CAIRO_FORMAT_ARGB32, relief.width, relief.height, 4 * relief.width));
    double const scale = relief.cells_a_pixel * px_per_cell;
    cairo_save(sheet);
    cairo_rectangle(sheet, where.x, where.y, where.width, where.height);
    cairo_clip(sheet);
    cairo_translate(sheet, where.x, where.y);
    cairo_scale(sheet, scale, scale);
    cairo_set_source_surface(sheet, image.get(), 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(sheet), scale > 1.0 ? CAIRO_FILTER_BILINEAR : CAIRO_FILTER_BEST);
    bool const is_svg = cairo_surface_get_type(cairo_get_target(sheet)) == CAIRO_SURFACE_TYPE_SVG;
    if (!is_svg) { // PNG has no such extension: Cairo 1.18 writes every pixel instead
        cairo_pattern_set_extend(cairo_get_source(sheet), CAIRO_EXTEND_PAD);
    }
    cairo_paint(sheet);
    cairo_restore(sheet);
    cairo_surface_finish(image.get());
}

void draw_summit(Cairo* sheet, Vec2 at, double half_height) {
    cairo_move_to(sheet, at.x, at.y - half_height);
    cairo_line_to(sheet, at.x + half_height, at.y + 0.75 * half_height);
    cairo_line_to(sheet, at.x - half_height, at.y + 0.75 * half_height);
    cairo_close_path(sheet);
    set_colour(sheet, {1.0, 1.0, 1.0, 0.75});
    cairo_set_line_width(sheet, 0.6 * half_height);
    cairo_stroke_preserve(sheet);
    set_colour(sheet, {0.10, 0.10, 0.12});
    cairo_fill(sheet);
}

Picture map(MapSheet const& sheet, MapParams const& params) {
    require_sheet(sheet, params);
    HeightRange const heights = height_range(sheet);
    Layout layout = lay_out(sheet, params, facts_of(sheet, params, heights));
    Relief const relief = tinted_relief(sheet, heights, density_of(params.format) * layout.ground.width);
    Window const& window = layout.window;
    double const unit = layout.unit;
    Mask const sea = sheet.sea ? holes_of(sheet.dem) : Mask{};
    bool const has_sea = sheet.sea && heights.holes > 0;
    LinesOnSheet lines = lines_on_sheet(sheet, window);
    lines.sea = has_sea ? shores_on_sheet(sea, window) : Shores{};
    lines.lakes = has_lakes(sheet) ? shores_on_sheet(*sheet.lakes, window) : Shores{};
    layout.legend.low_m = heights.low_m;
    layout.legend.high_m = heights.high_m;
    layout.legend.holes = heights.holes > 0 && !has_sea;
    layout.legend.sea = has_sea;
    layout.legend.lakes = !lines.lakes.empty();
    layout.legend.summits = !sheet.spot_heights.empty();
    layout.height = std::ceil(layout.legend_corner.y + legend_height(layout.legend, layout.legend_width, unit));

    return paint(layout.width, layout.height, params.format, [&](Cairo* canvas) {
        Box const& frame = window.frame;
        double const px_per_cell = sheet.dem.grid().cell_m * window.px_per_m;
        Labels const labels = place_labels(canvas, sheet, window, lines, params.contour_interval_m, unit);
        fill_box(canvas, frame, sheet.sea && sheet.sea->is_around ? deep_sea : no_data);
        cairo_save(canvas);
        cairo_rectangle(canvas, frame.x, frame.y, frame.width, frame.height);
        cairo_clip(canvas);
        draw_relief(canvas, relief, layout.ground, px_per_cell);
        draw_contours(canvas, sheet, lines, window, params.contour_interval_m, unit, labels.contours);
        draw_ridges(canvas, sheet, window, unit);
        draw_rivers(canvas, sheet, lines, window, unit);
        if (has_sea) {
            Relief const depths = sea_depths(sea);
            draw_water(canvas, lines.sea, &depths, layout.ground, px_per_cell, unit);
        }
        draw_water(canvas, lines.lakes, nullptr, layout.ground, px_per_cell, unit);
        draw_labels(canvas, labels);
        cairo_restore(canvas);
        draw_frame(canvas, layout);
        draw_heading(canvas, layout, params.title);
        draw_legend(canvas, layout.legend, layout.legend_corner, layout.legend_width, unit);
    });
}

Picture ground(MapSheet const& sheet, GroundParams const& params) {
    require_sheet(sheet, {});
    require_in("draw.ground", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_in("draw.ground", "shading", params.shading, Range::between(0.0, 1.0));
    Grid const& grid = whole_grid(sheet);
    constexpr std::int64_t longest = 16;
    refuse_if<BadInput>(
        grid.width < 2 || grid.height < 2 || grid.height - 1 > longest * (grid.width - 1) ||
            grid.width - 1 > longest * (grid.height - 1),
        "draw.ground",
        "the DEM has {} x {} cells: a texture needs 2 x 2, and sides not more than {} times as long as one another",
        grid.width, grid.height, longest);
    double const px_per_cell = static_cast<double>(params.width_px) / static_cast<double>(grid.width - 1);
    double const height = std::max(1.0, std::floor(px_per_cell * static_cast<double>(grid.height - 1) + 0.5));
    Box const all{-0.5 * px_per_cell, -0.5 * px_per_cell, px_per_cell * static_cast<double>(grid.width),
                  px_per_cell * static_cast<double>(grid.height)}; // outer halves of cells lie beyond the picture
    Window const window{all, grid.west, grid.north, px_per_cell / grid.cell_m};
    double const unit = std::max(0.6, static_cast<double>(params.width_px) / 1400.0);
    HeightRange const heights = height_range(sheet);
    double const px_per_shown = sheet.dem.grid().cell_m * window.px_per_m;
    Relief const relief = tinted_relief(sheet, heights, all.width, params.shading);
    return paint(params.width_px, height, Format::png, [&](Cairo* canvas) {
        fill_box(canvas, all, sheet.sea && sheet.sea->is_around ? deep_sea : no_data);
        draw_relief(canvas, relief, all, px_per_shown);
        draw_rivers(canvas, sheet, lines_on_sheet(sheet, window), window, unit);
        if (sheet.sea && heights.holes > 0) {
            Mask const sea = holes_of(sheet.dem);
            Relief const depths = sea_depths(sea);
            draw_water(canvas, shores_on_sheet(sea, window), &depths, all, px_per_shown, unit);
        }
        if (has_lakes(sheet)) {
            draw_water(canvas, shores_on_sheet(*sheet.lakes, window), nullptr, all, px_per_shown, unit);
        }
    });
}

} // namespace thalweg::draw
