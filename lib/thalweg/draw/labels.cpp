// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/labels.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <cairo.h>

#include <thalweg/draw/internal/map.hpp>
#include <thalweg/draw/sections.hpp>

namespace thalweg::draw {

std::array<Vec2, 4> Slab::corners() const {
    Vec2 const forth = half_length * along;
    Vec2 const up = half_height * Vec2{-along.y, along.x};
    return {centre - forth - up, centre + forth - up, centre + forth + up, centre - forth + up};
}

bool overlap(Slab const& a, Slab const& b) {
    // Convex shapes are apart if and only if one of their sides' normals separates them.
    for (Slab const* const slab : {&a, &b}) {
        for (Vec2 const axis : {slab->along, Vec2{-slab->along.y, slab->along.x}}) {
            auto const reach = [axis](Slab const& s) {
                return s.half_length * std::fabs(dot(axis, s.along)) +
                       s.half_height * std::fabs(dot(axis, {-s.along.y, s.along.x}));
            };
            if (std::fabs(dot(axis, a.centre - b.centre)) > reach(a) + reach(b)) {
                return false;
            }
        }
    }
    return true;
}

namespace {

/// Where lines run that labels avoid, in squares of a few pixels.
class AvoidedSquares {
public:
    AvoidedSquares(Box frame, double square_px)
        : frame_(frame), square_(square_px), columns_(squares(frame.width)), rows_(squares(frame.height)),
          has_line_(static_cast<std::size_t>(columns_ * rows_)) {}

    void add(std::vector<Vec2> const& line) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            auto const steps = static_cast<std::int64_t>(std::clamp(2.0 * distance(line[i - 1], line[i]) / square_, 1.0,
                                                                    1e5)); // a line may go far off the sheet
            for (std::int64_t k = 0; k <= steps; ++k) {
                double const share = static_cast<double>(k) / static_cast<double>(steps);
                std::int64_t const at = square_of(line[i - 1] + share * (line[i] - line[i - 1]));
                if (at >= 0) {
                    has_line_[static_cast<std::size_t>(at)] = true;
                }
            }
        }
    }

    /// The share [0, 1] of a slab that lines cover.
    double covered(Slab const& slab) const {
        std::int64_t all = 0;
        std::int64_t with_line = 0;
        Vec2 const up{-slab.along.y, slab.along.x};
        for (double s = -slab.half_length; s <= slab.half_length; s += square_) {
            for (double t = -slab.half_height; t <= slab.half_height; t += square_) {
                std::int64_t const at = square_of(slab.centre + s * slab.along + t * up);
                with_line += at >= 0 && has_line_[static_cast<std::size_t>(at)] ? 1 : 0;
                ++all;
            }
        }
        return static_cast<double>(with_line) / static_cast<double>(std::max<std::int64_t>(all, 1));
    }

private:
    std::int64_t squares(double pixels) const { return static_cast<std::int64_t>(pixels / square_) + 1; }
    std::int64_t square_of(Vec2 p) const {
        double const col = (p.x - frame_.x) / square_;
        double const row = (p.y - frame_.y) / square_;
        bool const inside =
            col >= 0.0 && row >= 0.0 && col < static_cast<double>(columns_) && row < static_cast<double>(rows_);
        return inside ? static_cast<std::int64_t>(row) * columns_ + static_cast<std::int64_t>(col) : -1;
    }

    Box frame_;
    double square_;
    std::int64_t columns_;
    std::int64_t rows_;
    std::vector<bool> has_line_;
};

bool is_inside(Slab const& slab, Box frame, double margin) {
    auto const corners = slab.corners();
    return std::all_of(corners.begin(), corners.end(), [&](Vec2 p) {
        return p.x >= frame.x + margin && p.x <= frame.right() - margin && p.y >= frame.y + margin &&
               p.y <= frame.bottom() - margin;
    });
}

/// Lengths of digits relative to their size: half the height, and the height of their middle over the base line.
constexpr double half_digit = 0.37;

/// What the search for places has at hand.
struct Search {
    Cairo* canvas;
    MapSheet const& sheet;
    Window const& window;
    LinesOnSheet const& lines;
    double interval_m;
    double unit;
    AvoidedSquares const& avoided;
    Labels labels = {};

    bool is_free(Slab const& room) const {
        auto const clear = [&](Label const& other) { return !overlap(room, other.room); };
        return is_inside(room, window.frame, 3.0 * unit) &&
               std::none_of(labels.marks.begin(), labels.marks.end(),
                            [&](Slab const& m) { return overlap(room, m); }) &&
               std::all_of(labels.heights.begin(), labels.heights.end(), clear) &&
               std::all_of(labels.contours.begin(), labels.contours.end(), clear);
    }
};

/// Heights as integers where these tell them apart.
int decimals_of_spots(MapSheet const& sheet) {
    HeightRange const heights = height_range(sheet);
    return heights.high_m - heights.low_m >= 50.0 ? 0 : 1;
}

void place_spot(Search& search, SpotHeight const& spot, int decimals) {
    double const unit = search.unit;
    TextStyle const style{12.5 * unit, {0.10, 0.10, 0.12}, Weight::normal, 1.6 * unit, Slant::italic};
    Slab const mark{search.window.at(spot.at), {1.0, 0.0}, 4.5 * unit, 4.5 * unit};
    bool const crowded = std::any_of(search.labels.marks.begin(), search.labels.marks.end(), [&](Slab const& other) {
        return distance(other.centre, mark.centre) < 45.0 * unit;
    });
    // On the map's border no one knows whether the land goes on rising.
    if (crowded || !is_inside(mark, search.window.frame, 8.0 * unit) || !search.is_free(mark)) {
        return;
    }
    Label label{number(spot.z, decimals), style, mark};
    label.room.half_length = 0.5 * text_width(search.canvas, label.text, style) + 2.0 * unit;
    label.room.half_height = half_digit * style.size + 2.0 * unit;
    double const beside = mark.half_length + label.room.half_length + 0.1 * unit;
    double const above = mark.half_height + label.room.half_height + 0.1 * unit;
    std::array<Vec2, 8> const places = {Vec2{beside, 0.0},     Vec2{0.0, -above},   Vec2{beside, -above},
                                        Vec2{beside, above},   Vec2{-beside, 0.0},  Vec2{0.0, above},
                                        Vec2{-beside, -above}, Vec2{-beside, above}};
    double least = 0.3; // of a label that lines may cover
    Label best = label;
    for (Vec2 const off : places) {
        label.room.centre = mark.centre + off;
        double const covered = search.avoided.covered(label.room);
        if (covered < least && search.is_free(label.room)) {
            least = covered;
            best = label;
        }
    }
    if (best.room.centre == mark.centre) {
        return; // no room
    }
    search.labels.marks.push_back(mark);
    search.labels.heights.push_back(best);
}

/// A place for a label on a contour, and how bad it is.
struct Seat {
    Slab room;
    double badness = 0.0;
    std::size_t contour = 0;
};

/// Point at a distance along a line. along: [px] of every vertex from the first.
Vec2 point_at(std::vector<Vec2> const& line, std::vector<double> const& along, double where) {
    auto const k = static_cast<std::size_t>(std::upper_bound(along.begin(), along.end(), where) - along.begin());
    if (k == 0 || k == line.size()) {
        return k == 0 ? line.front() : line.back();
    }
    double const step = along[k] - along[k - 1];
    double const share = step > 0.0 ? (where - along[k - 1]) / step : 0.0;
    return line[k - 1] + share * (line[k] - line[k - 1]);
}

/// A label's place on one stretch of a contour, badness: infinite for none.
Seat seat_on(Search const& search, std::vector<Vec2> const& line, std::vector<double> const& along, double where,
             Slab room) {
    constexpr int parts = 12;
    double const length = 2.0 * room.half_length;
    Vec2 const from = point_at(line, along, where);
    Vec2 const to = point_at(line, along, where + length);
    double const chord = distance(from, to);
    Seat seat{room, std::numeric_limits<double>::infinity()};
    if (!(chord > 0.8 * length)) {
        return seat;
    }
    Vec2 const direction = (1.0 / chord) * (to - from);
    Vec2 const normal{-direction.y, direction.x};
    double low = 0.0;
    double high = 0.0;
    for (int k = 1; k < parts; ++k) {
        double const off = dot(normal, point_at(line, along, where + length * k / parts) - from);
        low = std::min(low, off);
        high = std::max(high, off);
    }
    double const bend = (high - low) / (2.0 * room.half_height);
    if (bend > 0.8) {
        return seat;
    }
    constexpr double worst = 2.0;
    seat.room.centre = 0.5 * (from + to) + 0.5 * (low + high) * normal;
    seat.room.along = direction.x < 0.0 || (direction.x == 0.0 && direction.y > 0.0) ? -1.0 * direction : direction;
    // Steepness in contours that cross the label, and whether the digits' tops look uphill.
    Vec2 const up = room.half_height * Vec2{seat.room.along.y, -seat.room.along.x};
    double const above = height_at(search.sheet.dem, search.window.ground(seat.room.centre + 1.5 * up));
    double const below = height_at(search.sheet.dem, search.window.ground(seat.room.centre - 1.5 * up));
    double const contours =
        search.interval_m > 0.0 && std::isfinite(above - below) ? std::fabs(above - below) / search.interval_m : 2.0;
    double const tilt = std::fabs(seat.room.along.y);
    double const badness = bend + 0.5 * contours + 0.6 * tilt + (above < below ? 0.4 : 0.0);
    seat.badness = badness < worst ? badness : seat.badness;
    return seat;
}

std::vector<Seat> seats_on_contours(Search const& search, TextStyle const& style, int decimals) {
    std::vector<Seat> seats;
    for (std::size_t c = 0; c < search.sheet.contours.size(); ++c) {
        double const height_m = search.sheet.contours[c].first;
        std::vector<Vec2> const& line = search.lines.contours[c];
        if (line.size() < 2 || kind_of_contour(height_m, search.interval_m) != ContourKind::index) {
            continue;
        }
        Slab room;
        room.half_length = 0.5 * text_width(search.canvas, number(height_m, decimals), style) + 2.5 * search.unit;
        room.half_height = half_digit * style.size + 1.5 * search.unit;
        std::vector<double> along(line.size(), 0.0);
        for (std::size_t i = 1; i < line.size(); ++i) {
            along[i] = along[i - 1] + distance(line[i - 1], line[i]);
        }
        double const step = std::max(0.25 * room.half_length, along.back() / 20000.0);
        for (double where = 0.0; where + 2.0 * room.half_length < along.back(); where += step) {
            Seat seat = seat_on(search, line, along, where, room);
            seat.contour = c;
            if (std::isfinite(seat.badness) && search.avoided.covered(seat.room) == 0.0) {
                seats.push_back(seat);
            }
        }
    }
    std::stable_sort(seats.begin(), seats.end(), [](Seat const& a, Seat const& b) { return a.badness < b.badness; });
    return seats;
}

void place_on_contours(Search& search) {
    LineStyle const line_style = contour_style(ContourKind::index, search.unit);
    Colour const brown{line_style.colour.red, line_style.colour.green, line_style.colour.blue};
    TextStyle const style{10.5 * search.unit, brown, Weight::normal, 1.2 * search.unit};
    int const decimals = search.interval_m > 0.0 ? decimals_of(round_down(search.interval_m)) : 0;
    std::vector<double> heights; // of the labels, in their order
    for (Seat const& seat : seats_on_contours(search, style, decimals)) {
        double const height_m = search.sheet.contours[seat.contour].first;
        bool free = search.is_free(seat.room);
        for (std::size_t k = 0; free && k < search.labels.marks.size(); ++k) {
            free = distance(search.labels.marks[k].centre, seat.room.centre) >= 32.0 * search.unit;
        }
        for (std::size_t k = 0; free && k < heights.size(); ++k) {
            double const least = (heights[k] == height_m ? 230.0 : 120.0) * search.unit;
            free = distance(search.labels.contours[k].room.centre, seat.room.centre) >= least;
        }
        if (free) {
            search.labels.contours.push_back({number(height_m, decimals), style, seat.room});
            heights.push_back(height_m);
        }
    }
}

AvoidedSquares squares_to_avoid(LinesOnSheet const& lines, Window const& window, double unit) {
    AvoidedSquares squares(window.frame, 2.0 * unit);
    for (auto const* const list : {&lines.rivers, &lines.sea, &lines.lakes}) {
        for (std::vector<Vec2> const& line : *list) {
            squares.add(line);
        }
    }
    return squares;
}

} // namespace

Labels place_labels(Cairo* canvas, MapSheet const& sheet, Window const& window, LinesOnSheet const& lines,
                    double contour_interval_m, double unit) {
    AvoidedSquares const avoided = squares_to_avoid(lines, window, unit);
    Search search{canvas, sheet, window, lines, contour_interval_m, unit, avoided};
    int const decimals = decimals_of_spots(sheet);
    for (SpotHeight const& spot : sheet.spot_heights) {
        place_spot(search, spot, decimals);
    }
    place_on_contours(search);
    return std::move(search.labels);
}

void draw_labels(Cairo* canvas, Labels const& labels) {
    for (Slab const& mark : labels.marks) {
        draw_summit(canvas, mark.centre, mark.half_height);
    }
    for (auto const* const list : {&labels.contours, &labels.heights}) {
        for (Label const& label : *list) {
            Vec2 const down = half_digit * label.style.size * Vec2{-label.room.along.y, label.room.along.x};
            draw_text(canvas, label.room.centre + down, label.text, label.style, Anchor::middle, label.room.along);
        }
    }
}

} // namespace thalweg::draw
