// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/distributions.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <cairo.h>
#include <fmt/format.h>

#include <thalweg/core/numbers/ranks.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/internal/canvas.hpp>

namespace thalweg::draw {
namespace {

constexpr Colour inside_range{0.26, 0.47, 0.70};
constexpr Colour outside_range{0.87, 0.47, 0.13};
constexpr Colour without_range{0.52, 0.56, 0.61};
constexpr Colour range_band{0.86, 0.93, 0.84};
constexpr Colour range_edge{0.36, 0.58, 0.34};
constexpr Colour quiet_line{0.86, 0.86, 0.87};
constexpr double full_turn = 6.28318530717958648;
constexpr double most_px = 32000.0;
constexpr std::size_t most_dots = 20;   // members that are drawn as dots, above them as a histogram
constexpr std::size_t most_marks = 500; // dots of a response, of evenly chosen members

void require_indices(std::vector<Distribution> const& indices, char const* who) {
    for (Distribution const& index : indices) {
        for (double const value : index.values) {
            refuse_if<BadInput>(std::isinf(value), who, "a value of {} is infinite; mark unknown ones as NaN",
                                index.name);
        }
        refuse_if<BadInput>(index.low.has_value() != index.high.has_value() ||
                                (index.low && !(*index.low <= *index.high && std::isfinite(*index.high - *index.low))),
                            who, "the natural range of {} needs two finite ends, the lower first", index.name);
    }
}

bool is_in_range(Distribution const& index, double value) {
    return index.low && value >= *index.low && value <= *index.high;
}

Colour colour_of_member(Distribution const& index, double value) {
    return !index.low ? without_range : is_in_range(index, value) ? inside_range : outside_range;
}

std::vector<double> known_values(Distribution const& index) {
    std::vector<double> known;
    std::copy_if(index.values.begin(), index.values.end(), std::back_inserter(known),
                 [](double value) { return !std::isnan(value); });
    return known;
}

/// The place of everything on a sheet of small diagrams.
struct IndexSheet {
    double unit = 1.0; ///< [px] size of a small letter
    double width = 0.0;
    double height = 0.0;
    std::vector<Box> panels;                              ///< by index
    std::vector<std::pair<double, std::size_t>> headings; ///< y of the base line, first index of the group
};

/// \param high height of a panel in units
IndexSheet panel_places(std::vector<Distribution> const& indices, double width, double high, bool has_title,
                        bool has_note) {
    constexpr double margin = 1.8;
    constexpr double panel = 28.0;
    constexpr double gap = 2.4;
    auto const columns = static_cast<std::size_t>(std::clamp(width / 330.0, 1.0, 4.0));
    auto const across = static_cast<double>(columns);
    IndexSheet sheet;
    sheet.width = width;
    sheet.unit = width / (2.0 * margin + across * panel + (across - 1.0) * gap);
    double const unit = sheet.unit;
    double y = (has_title ? 3.4 : 1.2) + (has_note ? 1.8 : 0.0) + 2.2; // below title, note and legend
    std::size_t column = 0;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        bool const begins = i == 0 || indices[i].group != indices[i - 1].group;
        if (column == columns || (begins && column > 0)) {
            y += high;
            column = 0;
        }
        if (begins && !indices[i].group.empty()) {
            sheet.headings.emplace_back((y + 1.9) * unit, i);
            y += 3.0;
        }
        sheet.panels.push_back({(margin + static_cast<double>(column) * (panel + gap)) * unit, y * unit, panel * unit,
                                (high - 1.4) * unit});
        ++column;
    }
    y += indices.empty() ? 4.0 : high;
    sheet.height = std::ceil(y * unit);
    return sheet;
}

/// "3 to 5"
std::string words_of_range(Distribution const& index) {
    return *index.low == *index.high ? figures(*index.low, 3)
                                     : fmt::format("{} to {}", figures(*index.low, 3), figures(*index.high, 3));
}

void draw_title(Cairo* canvas, IndexSheet const& sheet, std::string const& title, std::string const& note) {
    double const unit = sheet.unit;
    double const left = 1.8 * unit;
    double const room = sheet.width - 2.0 * left;
    double y = 0.0;
    if (!title.empty()) {
        y = 2.6 * unit;
        draw_text_within(canvas, {left, y}, title, {1.5 * unit, ink, Weight::bold}, room);
    }
    if (!note.empty()) {
        y += 1.8 * unit;
        draw_text_within(canvas, {left, y}, note, {unit, faint_ink}, room);
    }
}

/// A sample of a colour or mark with words, from the left.
/// \return x of the next one
double draw_sample(Cairo* canvas, Vec2 at, double unit, char const* words, std::function<void(Box)> const& mark) {
    mark({at.x, at.y - 0.78 * unit, 1.4 * unit, 0.86 * unit});
    TextStyle const small{0.92 * unit, faint_ink};
    draw_text(canvas, {at.x + 1.9 * unit, at.y}, words, small);
    return at.x + 3.7 * unit + text_width(canvas, words, small);
}

void draw_range_legend(Cairo* canvas, IndexSheet const& sheet, std::vector<Distribution> const& indices, double y,
                       char const* line) {
    double const unit = sheet.unit;
    auto const has_range = [](Distribution const& index) { return index.low.has_value(); };
    double x = 1.8 * unit;
    auto const filled = [&](Colour colour) { return [canvas, colour](Box box) { fill_box(canvas, box, colour); }; };
    if (std::any_of(indices.begin(), indices.end(), has_range)) {
        x = draw_sample(canvas, {x, y}, unit, "natural range", [&](Box box) {
            fill_box(canvas, box, range_band);
            frame_box(canvas, box, 0.06 * unit, range_edge);
        });
        x = draw_sample(canvas, {x, y}, unit, "inside", filled(inside_range));
        x = draw_sample(canvas, {x, y}, unit, "outside", filled(outside_range));
    }
    if (!std::all_of(indices.begin(), indices.end(), has_range)) {
        x = draw_sample(canvas, {x, y}, unit, "no range known", filled(without_range));
    }
    if (line != nullptr) {
        draw_sample(canvas, {x, y}, unit, line, [&](Box box) {
            if (std::string_view(line) == "median") {
                double const middle = box.x + 0.5 * box.width;
                draw_line(canvas, {middle, box.y}, {middle, box.bottom()}, 0.14 * unit, ink);
            } else {
                double const middle = box.y + 0.5 * box.height;
                draw_line(canvas, {box.x, middle}, {box.right(), middle}, 0.14 * unit, ink);
            }
        });
    }
}

void draw_group_headings(Cairo* canvas, IndexSheet const& sheet, std::vector<Distribution> const& indices) {
    double const unit = sheet.unit;
    double const left = 1.8 * unit;
    for (auto const& [y, first] : sheet.headings) {
        draw_text_within(canvas, {left, y}, indices[first].group, {1.2 * unit, ink, Weight::bold},
                         sheet.width - 2.0 * left);
        draw_line(canvas, {left, y + 0.5 * unit}, {sheet.width - left, y + 0.5 * unit}, 0.06 * unit, quiet_line);
    }
}

/// The name of an index with its unit, and two texts below it.
void draw_panel_words(Cairo* canvas, Box panel, Distribution const& index, std::string const& left,
                      std::string const& right, double unit) {
    TextStyle const bold{unit, ink, Weight::bold};
    TextStyle const small{0.95 * unit, faint_ink};
    std::string const in_unit = index.unit.empty() ? "" : " [" + index.unit + "]";
    double const room = panel.width - text_width(canvas, in_unit, small);
    Vec2 const at{panel.x, panel.y + unit};
    draw_text_within(canvas, at, index.name, bold, room);
    draw_text(canvas, {panel.x + std::min(room, text_width(canvas, index.name, bold)), at.y}, in_unit, small);
    Vec2 const below{panel.x, panel.y + 2.45 * unit};
    double const taken = text_width(canvas, left, small) + 0.8 * unit;
    draw_text(canvas, below, left, small);
    draw_text_within(canvas, {panel.right(), below.y}, right, small, panel.width - taken, Anchor::end);
}

/// Bins of one width.
struct Bins {
    double low = 0.0; ///< lower end of the first
    double width = 1.0;
    std::vector<std::int64_t> inside;  ///< members in the natural range
    std::vector<std::int64_t> outside; ///< the others
    double high() const { return low + width * static_cast<double>(inside.size()); }
    std::int64_t most() const {
        std::int64_t most = 1;
        for (std::size_t i = 0; i < inside.size(); ++i) {
            most = std::max(most, inside[i] + outside[i]);
        }
        return most;
    }
};

bool are_whole(std::vector<double> const& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return v == std::floor(v) && std::fabs(v) < 1e9; });
}

/// Bins of a round width near that of Freedman and Diaconis, 5 to 30 of them; whole numbers lie in their middles.
Bins bins_of(Distribution const& index, std::vector<double> const& known) {
    auto const [least, greatest] = std::minmax_element(known.begin(), known.end());
    double const span = *greatest - *least;
    bool const whole = are_whole(known);
    double const quartiles = quantile(known, 0.75) - quantile(known, 0.25);
    double wide = 2.0 * quartiles / std::cbrt(static_cast<double>(known.size()));
    wide = std::clamp(wide > 0.0 ? wide : 0.1 * span, span / 24.0, span / 7.0);
    double const smallest = std::max({std::fabs(*least), std::fabs(*greatest), 1e-6}) * 1e-6;
    wide = round_down(std::max(wide, smallest) * 1.3);
    Bins bins;
    bins.width = whole ? std::max(1.0, wide) : wide;
    double const shift = whole && bins.width == 1.0 ? 0.5 : 0.0;
    bins.low = std::floor(*least / bins.width + shift + 1e-9) * bins.width - shift;
    double const last = std::max(0.0, std::floor((*greatest - bins.low) / bins.width - 1e-9));
    bins.inside.resize(static_cast<std::size_t>(last) + 1);
    bins.outside.resize(bins.inside.size());
    for (double const value : known) {
        double const at = std::clamp(std::floor((value - bins.low) / bins.width + 1e-9), 0.0, last);
        ++(is_in_range(index, value) ? bins.inside : bins.outside)[static_cast<std::size_t>(at)];
    }
    return bins;
}

/// Extends an interval to the ends of a natural range that are near it, and by a margin.
std::pair<double, double> with_range(Distribution const& index, double low, double high, double margin) {
    double const span = high - low;
    double from = low;
    double to = high;
    if (index.low) {
        for (double const end : {*index.low, *index.high}) {
            from = end < low && low - end <= span ? std::min(from, end) : from;
            to = end > high && end - high <= span ? std::max(to, end) : to;
        }
    }
    double const pad = margin * (to - from);
    return {from - pad, to + pad};
}

std::vector<std::pair<double, std::string>> ticks_of_panel(double low, double high, bool whole, int most) {
    Ticks const ticks = ticks_between(low, high, most);
    std::vector<std::pair<double, std::string>> found;
    for (double const value : ticks.values) {
        if (!whole || std::fabs(value - std::floor(value + 0.5)) < 1e-9) {
            found.emplace_back(value, number(value, whole ? 0 : ticks.decimals));
        }
    }
    return found;
}

/// The base line of a plot with ticks and numbers below it, which stay within the sides of the panel.
void draw_base_line(Cairo* canvas, Plot const& plot, bool whole, double unit) {
    TextStyle const small{0.9 * unit, faint_ink};
    double const y = plot.box.bottom();
    double free = -1e9;
    for (auto const& [value, words] : ticks_of_panel(plot.x_low, plot.x_high, whole, 5)) {
        double const x = plot.at(value, plot.y_low).x;
        draw_line(canvas, {x, y}, {x, y + 0.35 * unit}, 0.07 * unit, faint_ink);
        double const half = 0.5 * text_width(canvas, words, small);
        double const middle = std::min(x, plot.box.right() + 0.6 * unit - half);
        if (middle - half > free) {
            draw_text(canvas, {middle, y + 1.35 * unit}, words, small, Anchor::middle);
            free = middle + half + 0.5 * unit;
        }
    }
    draw_line(canvas, {plot.box.x, y}, {plot.box.right(), y}, 0.09 * unit, ink);
}

/// A triangle at a side of a plot: the natural range lies beyond it.
void draw_pointer(Cairo* canvas, Vec2 tip, Vec2 along, double size) {
    Vec2 const back{tip.x - size * along.x, tip.y - size * along.y};
    cairo_move_to(canvas, tip.x, tip.y);
    cairo_line_to(canvas, back.x - 0.6 * size * along.y, back.y + 0.6 * size * along.x);
    cairo_line_to(canvas, back.x + 0.6 * size * along.y, back.y - 0.6 * size * along.x);
    cairo_close_path(canvas);
    set_colour(canvas, range_edge);
    cairo_fill(canvas);
}

void draw_range_across(Cairo* canvas, Plot const& plot, Distribution const& index, bool whole, double unit) {
    if (!index.low) {
        return;
    }
    double const half = whole ? 0.5 : 0.0;
    double const low = std::max(*index.low - half, plot.x_low);
    double const high = std::min(*index.high + half, plot.x_high);
    double const middle = plot.box.y + 0.5 * plot.box.height;
    if (low > plot.x_high || high < plot.x_low) {
        bool const beyond = low > plot.x_high;
        draw_pointer(canvas, {beyond ? plot.box.right() : plot.box.x, middle}, {beyond ? 1.0 : -1.0, 0.0}, 0.9 * unit);
        return;
    }
    double const left = plot.at(low, plot.y_low).x;
    double const right = std::max(plot.at(high, plot.y_low).x, left + 0.2 * unit);
    fill_box(canvas, {left, plot.box.y, right - left, plot.box.height}, range_band);
    for (auto const& [end, x] : {std::pair(*index.low - half, left), std::pair(*index.high + half, right)}) {
        if (end >= plot.x_low && end <= plot.x_high) {
            draw_line(canvas, {x, plot.box.y}, {x, plot.box.bottom()}, 0.07 * unit, range_edge);
        }
    }
}

void draw_histogram(Cairo* canvas, Plot const& plot, Distribution const& index, Bins const& bins, double unit) {
    double const scale = round_down(static_cast<double>(bins.most()));
    Vec2 const line = plot.at(plot.x_low, scale);
    draw_line(canvas, line, {plot.box.right(), line.y}, 0.06 * unit, {0.0, 0.0, 0.0, 0.12});
    draw_text(canvas, {plot.box.x - 0.4 * unit, line.y + 0.33 * unit}, number(scale, 0), {0.9 * unit, faint_ink},
              Anchor::end);
    double const gap = 0.04 * bins.width * (plot.box.width / (plot.x_high - plot.x_low));
    for (std::size_t i = 0; i < bins.inside.size(); ++i) {
        double const left = bins.low + bins.width * static_cast<double>(i);
        double base = 0.0;
        auto const bar = [&](std::int64_t members, Colour colour) {
            double const top = base + static_cast<double>(members);
            Vec2 const from = plot.at(left, top);
            Vec2 const to = plot.at(left + bins.width, base);
            if (members > 0) {
                fill_box(canvas, {from.x + gap, from.y, to.x - from.x - 2.0 * gap, to.y - from.y}, colour);
            }
            base = top;
        };
        bar(bins.inside[i], inside_range);
        bar(bins.outside[i], index.low ? outside_range : without_range);
    }
}

/// A dot for each value, above those beside it that it would cover.
void draw_dots(Cairo* canvas, Plot const& plot, Distribution const& index, std::vector<double> values, double unit) {
    std::sort(values.begin(), values.end());
    double const size = 0.9 * unit;
    std::vector<double> ends; // of the last dot in each row
    std::vector<std::size_t> rows;
    for (double const value : values) {
        double const x = plot.at(value, plot.y_low).x;
        auto const free = std::find_if(ends.begin(), ends.end(), [&](double end) { return end <= x - size; });
        rows.push_back(static_cast<std::size_t>(free - ends.begin()));
        if (free == ends.end()) {
            ends.push_back(x);
        } else {
            *free = x;
        }
    }
    double const room = plot.box.height - 1.2 * size;
    double const step = ends.size() > 1 ? std::min(1.1 * size, room / static_cast<double>(ends.size() - 1)) : 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        double const y = plot.box.bottom() - 0.65 * size - step * static_cast<double>(rows[i]);
        cairo_new_sub_path(canvas);
        cairo_arc(canvas, plot.at(values[i], plot.y_low).x, y, 0.5 * size, 0.0, full_turn);
        set_colour(canvas, colour_of_member(index, values[i]));
        cairo_fill_preserve(canvas);
        set_colour(canvas, paper);
        cairo_set_line_width(canvas, 0.08 * unit);
        cairo_stroke(canvas);
    }
}

void draw_median(Cairo* canvas, Plot const& plot, double median, double unit) {
    double const x = plot.at(median, plot.y_low).x;
    draw_line(canvas, {x, plot.box.y}, {x, plot.box.bottom()}, 0.22 * unit, {1.0, 1.0, 1.0, 0.7});
    draw_line(canvas, {x, plot.box.y}, {x, plot.box.bottom()}, 0.13 * unit, ink);
}

void draw_distribution(Cairo* canvas, Box panel, Distribution const& index, double unit) {
    std::vector<double> const known = known_values(index);
    DistributionCounts const counts = counts_of(index);
    if (known.empty()) {
        draw_panel_words(canvas, panel, index, "no member has a number", "", unit);
        return;
    }
    double const median = quantile(known, 0.5);
    bool const all = known.size() == index.values.size();
    draw_panel_words(
        canvas, panel, index,
        all ? "median " + figures(median, 3) : fmt::format("median of {}: {}", counts.known, figures(median, 3)),
        counts.inside ? fmt::format("{} of {} inside {}", *counts.inside, counts.known, words_of_range(index)) : "",
        unit);
    Bins const bins = bins_of(index, known);
    bool const dots = known.size() <= most_dots;
    bool const whole = are_whole(known);
    double low = bins.low;
    double high = bins.high();
    double const least = (whole ? 3.0 : 1.0) * bins.width;
    if (high - low < least) {
        high = low + least;
    }
    auto const [from, to] = with_range(index, low, high, 0.02);
    double const left = panel.x + 2.2 * unit;
    double const top = panel.y + 3.3 * unit;
    Plot const plot{{left, top, panel.right() - 0.6 * unit - left, panel.bottom() - 1.9 * unit - top},
                    from,
                    to,
                    0.0,
                    1.08 * static_cast<double>(bins.most())};
    draw_range_across(canvas, plot, index, whole, unit);
    if (dots) {
        draw_dots(canvas, plot, index, known, unit);
    } else {
        draw_histogram(canvas, plot, index, bins, unit);
    }
    draw_median(canvas, plot, median, unit);
    draw_base_line(canvas, plot, whole, unit);
}

template <class DrawPanel>
Picture sheet_of_panels(std::vector<Distribution> const& indices, DistributionsParams const& params, char const* who,
                        double high, char const* line, DrawPanel const& draw_panel) {
    IndexSheet const sheet = panel_places(indices, params.width_px, high, !params.title.empty(), !params.note.empty());
    refuse_if<BadInput>(
        sheet.height > most_px, who,
        "{} indices make a picture of {:.0f} pixels in height, more than 32000: draw fewer, or a narrower picture",
        indices.size(), sheet.height);
    return paint(params.width_px, sheet.height, params.format, [&](Cairo* canvas) {
        draw_title(canvas, sheet, params.title, params.note);
        double const y = ((params.title.empty() ? 0.0 : 2.6) + (params.note.empty() ? 0.0 : 1.8) + 2.1) * sheet.unit;
        if (indices.empty()) {
            draw_text(canvas, {1.8 * sheet.unit, y}, "no indices", {sheet.unit, faint_ink});
            return;
        }
        draw_range_legend(canvas, sheet, indices, y, line);
        draw_group_headings(canvas, sheet, indices);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            draw_panel(canvas, sheet.panels[i], indices[i], sheet.unit);
        }
    });
}

/// The medians of parameter and index by value of the parameter if these are few, else of groups of members of equal
/// size; none of too few members.
std::vector<Vec2> medians_of(std::vector<Vec2> places) {
    constexpr std::size_t most_values = 8;
    constexpr std::size_t a_group = 10;
    std::stable_sort(places.begin(), places.end(), [](Vec2 a, Vec2 b) { return a.x < b.x; });
    std::vector<std::size_t> ends; // of the groups
    for (std::size_t i = 1; i <= places.size(); ++i) {
        if (i == places.size() || places[i].x != places[i - 1].x) {
            ends.push_back(i);
        }
    }
    if (ends.size() > most_values) {
        ends.clear();
        std::size_t const groups = std::min(places.size() / a_group, most_values);
        for (std::size_t g = 1; groups > 1 && g <= groups; ++g) {
            ends.push_back(g * places.size() / groups);
        }
    }
    std::vector<Vec2> medians;
    std::size_t first = 0;
    for (std::size_t const end : ends) {
        std::vector<double> xs;
        std::vector<double> ys;
        for (; first < end; ++first) {
            xs.push_back(places[first].x);
            ys.push_back(places[first].y);
        }
        medians.push_back({quantile(xs, 0.5), quantile(ys, 0.5)});
    }
    return medians;
}

/// The natural range as a band from left to right.
void draw_range_along(Cairo* canvas, Plot const& plot, Distribution const& index, double unit) {
    if (!index.low) {
        return;
    }
    double const middle = plot.box.x + 0.5 * plot.box.width;
    if (*index.low > plot.y_high || *index.high < plot.y_low) {
        bool const above = *index.low > plot.y_high;
        draw_pointer(canvas, {middle, above ? plot.box.y : plot.box.bottom()}, {0.0, above ? -1.0 : 1.0}, 0.9 * unit);
        return;
    }
    double const top = plot.at(plot.x_low, std::min(*index.high, plot.y_high)).y;
    double const bottom = std::max(plot.at(plot.x_low, std::max(*index.low, plot.y_low)).y, top + 0.2 * unit);
    fill_box(canvas, {plot.box.x, top, plot.box.width, bottom - top}, range_band);
    for (auto const& [end, y] : {std::pair(*index.low, bottom), std::pair(*index.high, top)}) {
        if (end >= plot.y_low && end <= plot.y_high) {
            draw_line(canvas, {plot.box.x, y}, {plot.box.right(), y}, 0.07 * unit, range_edge);
        }
    }
}

/// Widens an interval that is too narrow for an axis, and leaves a margin.
std::pair<double, double> axis_around(double low, double high) {
    double const least = std::max({std::fabs(low) * 1e-6, std::fabs(high) * 1e-6, 1e-9});
    double const pad = high - low < least ? std::max(0.5, least) : 0.04 * (high - low);
    return {low - pad, high + pad};
}

void draw_upright_axis(Cairo* canvas, Plot const& plot, bool whole, double unit) {
    TextStyle const small{0.9 * unit, faint_ink};
    for (auto const& [value, words] : ticks_of_panel(plot.y_low, plot.y_high, whole, 4)) {
        double const y = plot.at(plot.x_low, value).y;
        draw_line(canvas, {plot.box.x - 0.35 * unit, y}, {plot.box.x, y}, 0.07 * unit, faint_ink);
        draw_text_within(canvas, {plot.box.x - 0.55 * unit, y + 0.33 * unit}, words, small, 4.2 * unit, Anchor::end);
    }
    draw_line(canvas, {plot.box.x, plot.box.y}, {plot.box.x, plot.box.bottom()}, 0.09 * unit, ink);
}

/// The base line of a plot with words below it.
void draw_words_below(Cairo* canvas, Plot const& plot, std::vector<std::string> const& words, double unit) {
    double const y = plot.box.bottom();
    double const room = plot.box.width / static_cast<double>(words.size()) - 0.4 * unit;
    for (std::size_t i = 0; i < words.size(); ++i) {
        double const x = plot.at(static_cast<double>(i), plot.y_low).x;
        TextStyle const small{0.9 * unit, faint_ink};
        double const wide = std::min(room, text_width(canvas, words[i], small));
        draw_text_within(canvas, {x - 0.5 * wide, y + 1.35 * unit}, words[i], small, wide);
    }
    draw_line(canvas, {plot.box.x, y}, {plot.box.right(), y}, 0.09 * unit, ink);
}

void draw_medians(Cairo* canvas, std::vector<Vec2> const& medians, bool are_words, double unit) {
    for (auto const& [width, colour] : {std::pair(0.3, Colour{1.0, 1.0, 1.0, 0.7}), std::pair(0.13, ink)}) {
        if (are_words) {
            for (Vec2 const at : medians) {
                draw_line(canvas, {at.x - 1.6 * unit, at.y}, {at.x + 1.6 * unit, at.y}, width * unit, colour);
            }
            continue;
        }
        trace_line(canvas, medians, 0.0);
        set_colour(canvas, colour);
        cairo_set_line_width(canvas, width * unit);
        cairo_stroke(canvas);
    }
}

/// Members by parameter and index, without those that lack one of them.
std::vector<Vec2> places_of(Distribution const& parameter, Distribution const& index) {
    std::vector<Vec2> places;
    for (std::size_t i = 0; i < index.values.size(); ++i) {
        if (!std::isnan(index.values[i]) && !std::isnan(parameter.values[i])) {
            places.push_back({parameter.values[i], index.values[i]});
        }
    }
    return places;
}

Plot plot_of_response(Box panel, std::vector<Vec2> const& places, Distribution const& index,
                      std::vector<std::string> const& words, double unit) {
    auto const by_x = [](Vec2 a, Vec2 b) { return a.x < b.x; };
    auto const by_y = [](Vec2 a, Vec2 b) { return a.y < b.y; };
    auto const [left_most, right_most] = std::minmax_element(places.begin(), places.end(), by_x);
    auto const [lowest, highest] = std::minmax_element(places.begin(), places.end(), by_y);
    auto const [x_low, x_high] = words.empty() ? axis_around(left_most->x, right_most->x)
                                               : std::pair(-0.5, static_cast<double>(words.size()) - 0.5);
    auto const [y_least, y_most] = axis_around(lowest->y, highest->y);
    auto const [y_low, y_high] = with_range(index, y_least, y_most, 0.02);
    double const left = panel.x + 5.0 * unit;
    double const top = panel.y + 3.3 * unit;
    return {{left, top, panel.right() - 0.6 * unit - left, panel.bottom() - 1.9 * unit - top},
            x_low,
            x_high,
            y_low,
            y_high};
}

/// A dot for each place, those of one colour in one path: a file with a path for each would be large.
void draw_marks(Cairo* canvas, Plot const& plot, std::vector<Vec2> const& places, Distribution const& index,
                bool are_words, double unit) {
    std::size_t const marks = std::min(places.size(), most_marks);
    cairo_save(canvas);
    cairo_set_line_cap(canvas, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_width(canvas, 0.52 * unit);
    for (bool const inside : {false, true}) {
        Colour colour = !index.low ? without_range : inside ? inside_range : outside_range;
        colour.alpha = 0.75;
        for (std::size_t i = 0; i < marks; ++i) {
            Vec2 const place = places[i * places.size() / marks];
            double const turn = 0.61803398875 * static_cast<double>(i);
            double const aside = are_words ? (turn - std::floor(turn) - 0.5) * 2.4 * unit : 0.0; // equal words apart
            if (is_in_range(index, place.y) == inside) {
                Vec2 const at = plot.at(place.x, place.y);
                cairo_move_to(canvas, at.x + aside, at.y);
                cairo_line_to(canvas, at.x + aside, at.y);
            }
        }
        set_colour(canvas, colour);
        cairo_stroke(canvas);
    }
    cairo_restore(canvas);
}

void draw_response(Cairo* canvas, Box panel, Distribution const& parameter, Distribution const& index,
                   std::vector<std::string> const& words, double unit) {
    std::vector<Vec2> const places = places_of(parameter, index);
    if (places.empty()) {
        draw_panel_words(canvas, panel, index, "no member has a number", "", unit);
        return;
    }
    double const rank = rank_correlation(parameter.values, index.values);
    std::string const correlation = std::isnan(rank) ? "ρ unknown" : "ρ " + number(rank, 2);
    draw_panel_words(canvas, panel, index, words.empty() ? correlation : fmt::format("{} members", places.size()),
                     index.low ? "range " + words_of_range(index) : "", unit);
    Plot const plot = plot_of_response(panel, places, index, words, unit);
    draw_range_along(canvas, plot, index, unit);
    draw_marks(canvas, plot, places, index, !words.empty(), unit);
    std::vector<Vec2> medians = medians_of(places);
    if (!medians.empty()) {
        std::transform(medians.begin(), medians.end(), medians.begin(), [&](Vec2 p) { return plot.at(p.x, p.y); });
        draw_medians(canvas, medians, !words.empty(), unit);
    }
    bool const whole = std::all_of(places.begin(), places.end(), [](Vec2 p) { return p.y == std::floor(p.y); });
    draw_upright_axis(canvas, plot, whole, unit);
    if (words.empty()) {
        draw_base_line(canvas, plot, false, unit);
    } else {
        draw_words_below(canvas, plot, words, unit);
    }
}

} // namespace

DistributionCounts counts_of(Distribution const& index) {
    DistributionCounts counts;
    std::int64_t inside = 0;
    for (double const value : index.values) {
        counts.known += std::isnan(value) ? 0 : 1;
        inside += is_in_range(index, value) ? 1 : 0;
    }
    if (index.low) {
        counts.inside = inside;
    }
    return counts;
}

Picture distributions(std::vector<Distribution> const& indices, DistributionsParams const& params) {
    require_in("draw.distributions", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_indices(indices, "draw.distributions");
    constexpr double high = 13.6;
    return sheet_of_panels(indices, params, "draw.distributions", high, "median", draw_distribution);
}

Picture responses(Distribution const& parameter, std::vector<Distribution> const& indices,
                  ResponsesParams const& params) {
    require_in("draw.responses", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_indices({parameter}, "draw.responses");
    require_indices(indices, "draw.responses");
    for (Distribution const& index : indices) {
        refuse_if<BadInput>(index.values.size() != parameter.values.size(), "draw.responses",
                            "{} has {} values and {} has {}: one for each member is required", index.name,
                            index.values.size(), parameter.name, parameter.values.size());
    }
    for (double const value : parameter.values) {
        refuse_if<BadInput>(
            !params.words.empty() && !std::isnan(value) &&
                !(value >= 0.0 && value < static_cast<double>(params.words.size()) && value == std::floor(value)),
            "draw.responses", "{} of {} is not the number of one of its {} words", value, parameter.name,
            params.words.size());
    }
    constexpr double high = 15.6;
    DistributionsParams const alike{params.title, params.note, params.width_px, params.format};
    return sheet_of_panels(indices, alike, "draw.responses", high, "medians",
                           [&](Cairo* canvas, Box panel, Distribution const& index, double unit) {
                               draw_response(canvas, panel, parameter, index, params.words, unit);
                           });
}

} // namespace thalweg::draw
