// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <cairo.h>
#include <fmt/format.h>

#include <thalweg/draw/internal/map.hpp>
#include <thalweg/draw/internal/water.hpp>

namespace thalweg::draw {
namespace {

constexpr double row_height = 92.0; ///< [units]
constexpr double gap = 36.0;

/// One part of the legend: its width [units] and a function that draws it from its upper left corner.
struct Block {
    double width = 0.0;
    std::function<void(Cairo*, Vec2)> draw;
};

struct Styles {
    explicit Styles(double unit)
        : heading{14.0 * unit, ink, Weight::bold}, text{13.0 * unit, ink}, small{12.0 * unit, faint_ink} {}
    TextStyle heading;
    TextStyle text;
    TextStyle small;
};

Block north_arrow(double unit) {
    return {24.0, [unit](Cairo* sheet, Vec2 at) {
                double const x = at.x + 12.0 * unit;
                for (double const side : {-1.0, 1.0}) {
                    cairo_move_to(sheet, x, at.y + 18.0 * unit);
                    cairo_line_to(sheet, x + side * 8.0 * unit, at.y + 54.0 * unit);
                    cairo_line_to(sheet, x, at.y + 46.0 * unit);
                    cairo_close_path(sheet);
                    set_colour(sheet, side < 0.0 ? ink : paper);
                    cairo_fill_preserve(sheet);
                    set_colour(sheet, ink);
                    cairo_set_line_width(sheet, 0.9 * unit);
                    cairo_stroke(sheet);
                }
                draw_text(sheet, {x, at.y + 13.0 * unit}, "N", Styles(unit).heading, Anchor::middle);
            }};
}

/// A bar of four round parts.
Block scale_bar(LegendFacts const& facts, double unit) {
    double const longest = std::clamp(0.3 * facts.ground_px, 60.0 * unit, 220.0 * unit);
    double const part_m = round_down(longest / (4.0 * facts.px_per_m));
    double const part_px = part_m * facts.px_per_m;
    bool const in_km = 4.0 * part_m >= 1000.0;
    double const shown = in_km ? part_m / 1000.0 : part_m;
    return {std::max(180.0, longest / unit + 60.0), [=](Cairo* sheet, Vec2 at) {
                Styles const style(unit);
                double const top = at.y + 22.0 * unit;
                double const left = at.x + 6.0 * unit;
                for (int k = 0; k < 4; ++k) {
                    Box const part{left + k * part_px, top, part_px, 7.0 * unit};
                    fill_box(sheet, part, k % 2 == 0 ? ink : paper);
                    frame_box(sheet, part, 0.9 * unit, ink);
                }
                int const decimals = decimals_of(shown);
                for (int const k : {0, 2, 4}) {
                    draw_text(sheet, {left + k * part_px, at.y + 15.0 * unit}, number(k * shown, decimals), style.small,
                              Anchor::middle);
                }
                double const beside = left + 4.0 * part_px +
                                      0.6 * text_width(sheet, number(4 * shown, decimals), style.small) + 4.0 * unit;
                draw_text(sheet, {beside, at.y + 15.0 * unit}, in_km ? "km" : "m", style.small);
            }};
}

Block height_ramp(LegendFacts const& facts, double unit) {
    double const width = 270.0;
    return {width, [=](Cairo* sheet, Vec2 at) {
                Styles const style(unit);
                draw_text(sheet, {at.x, at.y + 13.0 * unit}, "Height [m]", style.heading);
                Box const ramp{at.x, at.y + 22.0 * unit, width * unit, 16.0 * unit};
                double const span = facts.high_m - facts.low_m;
                if (!(span > 0.0)) { // one height or none: a swatch
                    Box const swatch{ramp.x, ramp.y, 34.0 * unit, ramp.height};
                    fill_box(sheet, swatch, span == 0.0 ? tint(0.4) : no_data);
                    frame_box(sheet, swatch, 0.8 * unit, ink);
                    draw_text(sheet, {swatch.right() + 8.0 * unit, ramp.bottom() - 3.0 * unit},
                              span == 0.0 ? number(facts.low_m, facts.low_m == std::floor(facts.low_m) ? 0 : 2)
                                          : "no heights",
                              style.text);
                    return;
                }
                cairo_pattern_t* const colours = cairo_pattern_create_linear(ramp.x, 0.0, ramp.right(), 0.0);
                for (int k = 0; k <= 32; ++k) {
                    Colour const colour = tint(k / 32.0);
                    cairo_pattern_add_color_stop_rgb(colours, k / 32.0, colour.red, colour.green, colour.blue);
                }
                cairo_set_source(sheet, colours);
                cairo_pattern_destroy(colours); // the sheet owns it now
                cairo_rectangle(sheet, ramp.x, ramp.y, ramp.width, ramp.height);
                cairo_fill(sheet);
                frame_box(sheet, ramp, 0.8 * unit, ink);
                Ticks const ticks = ticks_between(facts.low_m, facts.high_m, 4);
                for (double const z : ticks.values) {
                    double const x = ramp.x + (z - facts.low_m) / span * ramp.width;
                    draw_line(sheet, {x, ramp.y}, {x, ramp.bottom() + 4.0 * unit}, 0.8 * unit, ink);
                    draw_text(sheet, {x, ramp.bottom() + 17.0 * unit}, number(z, ticks.decimals), style.small,
                              Anchor::middle);
                }
                int const decimals = decimals_of(ticks.step / 10.0);
                draw_text(sheet, {ramp.right(), at.y + 13.0 * unit},
                          number(facts.low_m, decimals) + " – " + number(facts.high_m, decimals), style.small,
                          Anchor::end);
            }};
}

/// Styles of rivers with their labels.
using RiverSamples = std::vector<std::pair<LineStyle, std::string>>;

RiverSamples rivers_by_order(RiverScale const& scale, double unit) {
    RiverSamples rivers;
    for (int order = 1; order <= scale.highest_order; ++order) {
        rivers.emplace_back(style_of_order(order, scale, unit), fmt::format("{}", order));
    }
    return rivers;
}

/// A round area near the largest, and a few powers of ten below it.
RiverSamples rivers_by_area(RiverScale const& scale, double unit) {
    constexpr std::size_t most = 4;
    double const largest_km2 = round_down(scale.largest_area_m2 / 1e6);
    RiverSamples rivers{{style_of_area(largest_km2 * 1e6, scale, unit), fmt::format("{:.6g}", largest_km2)}};
    double const below = std::pow(10.0, std::ceil(std::log10(largest_km2) - 1e-9) - 1.0);
    for (double km2 = below; rivers.size() < most; km2 /= 10.0) {
        rivers.emplace_back(style_of_area(km2 * 1e6, scale, unit), fmt::format("{:.6g}", km2));
    }
    std::reverse(rivers.begin(), rivers.end());
    return rivers;
}

Block river_samples(RiverScale const& scale, double unit) {
    bool const areas = scale.largest_area_m2 > 0.0;
    RiverSamples const rivers = areas ? rivers_by_area(scale, unit) : rivers_by_order(scale, unit);
    double const step = std::min(areas ? 52.0 : 44.0, 330.0 / static_cast<double>(rivers.size()));
    return {std::max(130.0, step * static_cast<double>(rivers.size())), [=](Cairo* sheet, Vec2 at) {
                Styles const style(unit);
                draw_text(sheet, {at.x, at.y + 13.0 * unit}, areas ? "Area drained [km²]" : "Strahler order",
                          style.heading);
                double x = at.x;
                for (auto const& [river, words] : rivers) {
                    double const run = 0.75 * step * unit;
                    double const y = at.y + 31.0 * unit;
                    cairo_set_line_cap(sheet, CAIRO_LINE_CAP_ROUND);
                    cairo_move_to(sheet, x + 2.0 * unit, y + 5.0 * unit);
                    cairo_curve_to(sheet, x + 0.35 * run, y - 13.0 * unit, x + 0.65 * run, y + 13.0 * unit, x + run,
                                   y - 5.0 * unit);
                    set_colour(sheet, river.colour);
                    cairo_set_line_width(sheet, river.width_px);
                    cairo_stroke(sheet);
                    cairo_set_line_cap(sheet, CAIRO_LINE_CAP_BUTT);
                    draw_text(sheet, {x + 0.5 * run, at.y + 55.0 * unit}, words, style.small, Anchor::middle);
                    x += step * unit;
                }
            }};
}

Block contour_samples(LegendFacts const& facts, double unit) {
    return {130.0, [=, interval = facts.contour_interval_m](Cairo* sheet, Vec2 at) {
                Styles const style(unit);
                draw_text(sheet, {at.x, at.y + 13.0 * unit}, "Contours", style.heading);
                double y = at.y + 32.0 * unit;
                for (ContourKind const kind : {ContourKind::ordinary, ContourKind::index}) {
                    LineStyle const line = contour_style(kind, unit);
                    draw_line(sheet, {at.x, y}, {at.x + 34.0 * unit, y}, line.width_px, line.colour);
                    double const apart = kind == ContourKind::index ? index_every * interval : interval;
                    draw_text(sheet, {at.x + 44.0 * unit, y + 4.5 * unit}, fmt::format("every {:.6g} m", apart),
                              style.small);
                    y += 22.0 * unit;
                }
            }};
}

/// A sign of the map and its name, drawn around the left end of its base line.
struct Sign {
    char const* name;
    std::function<void(Cairo*, Vec2)> draw;
};

Sign area_sign(char const* name, Colour colour, double unit) {
    return {name, [=](Cairo* sheet, Vec2 at) {
                Box const swatch{at.x, at.y - 11.0 * unit, 28.0 * unit, 13.0 * unit};
                fill_box(sheet, swatch, colour);
                frame_box(sheet, swatch, 0.8 * unit, faint_ink);
            }};
}

std::vector<Sign> signs_of(LegendFacts const& facts, double unit) {
    std::vector<Sign> signs;
    if (facts.summits) {
        signs.push_back({"summit, height", [unit](Cairo* sheet, Vec2 at) {
                             draw_summit(sheet, {at.x + 14.0 * unit, at.y - 4.0 * unit}, 4.5 * unit);
                         }});
    }
    if (facts.ridges) {
        signs.push_back({"ridge", [unit](Cairo* sheet, Vec2 at) {
                             LineStyle const line = ridge_style(unit);
                             double const y = at.y - 4.5 * unit;
                             draw_line(sheet, {at.x, y}, {at.x + 28.0 * unit, y}, line.width_px, line.colour);
                         }});
    }
    if (facts.sea) {
        signs.push_back(area_sign("sea", mix(shallow_sea, deep_sea, 0.5), unit));
    }
    if (facts.lakes) {
        signs.push_back(area_sign("lake", lake_colour, unit));
    }
    if (facts.holes && facts.low_m <= facts.high_m) {
        signs.push_back(area_sign("no data", no_data, unit));
    }
    return signs;
}

/// Up to three signs, one below the other.
Block sign_samples(std::vector<Sign> const& signs, double unit) {
    return {130.0, [=](Cairo* sheet, Vec2 at) {
                Vec2 base{at.x, at.y + 13.0 * unit};
                for (Sign const& sign : signs) {
                    sign.draw(sheet, base);
                    draw_text(sheet, {base.x + 38.0 * unit, base.y}, sign.name, Styles(unit).small);
                    base.y += 22.0 * unit;
                }
            }};
}

/// Arranges the blocks in rows.
std::vector<std::vector<Block>> rows_of(LegendFacts const& facts, double width, double unit) {
    std::vector<Block> blocks{north_arrow(unit), scale_bar(facts, unit), height_ramp(facts, unit)};
    if (facts.rivers.highest_order > 0) {
        blocks.push_back(river_samples(facts.rivers, unit));
    }
    if (facts.contour_interval_m > 0.0) {
        blocks.push_back(contour_samples(facts, unit));
    }
    std::vector<Sign> const signs = signs_of(facts, unit);
    constexpr std::size_t rows_of_signs = 3;
    for (std::size_t k = 0; k < signs.size(); k += rows_of_signs) {
        auto const first = signs.begin() + static_cast<std::ptrdiff_t>(k);
        auto const last = signs.begin() + static_cast<std::ptrdiff_t>(std::min(k + rows_of_signs, signs.size()));
        blocks.push_back(sign_samples({first, last}, unit));
    }
    std::vector<std::vector<Block>> rows(1);
    double used = 0.0;
    for (Block& block : blocks) {
        if (!rows.back().empty() && used + gap + block.width > width / unit) {
            rows.emplace_back();
        }
        used = rows.back().empty() ? block.width : used + gap + block.width;
        rows.back().push_back(std::move(block));
    }
    return rows;
}

} // namespace

double legend_height(LegendFacts const& facts, double width, double unit) {
    return static_cast<double>(rows_of(facts, width, unit).size()) * row_height * unit;
}

void draw_legend(Cairo* sheet, LegendFacts const& facts, Vec2 corner, double width, double unit) {
    double y = corner.y;
    for (std::vector<Block> const& row : rows_of(facts, width, unit)) {
        double x = corner.x;
        for (Block const& block : row) {
            block.draw(sheet, {x, y});
            x += (block.width + gap) * unit;
        }
        y += row_height * unit;
    }
}

} // namespace thalweg::draw
