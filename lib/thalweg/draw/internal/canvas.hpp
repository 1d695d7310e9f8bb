// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/core/vec.hpp>
#include <thalweg/draw/picture.hpp>

struct _cairo; // Cairo's own name: cairo.h stays in the .cpp files

namespace thalweg::draw {

// Drawing primitives of all pictures: a sheet in memory, colours, lines and text. Lengths on a sheet are pixels, x to
// the right, y down.

using Cairo = ::_cairo;

struct Colour {
    double red = 0.0; ///< [0, 1], like the others
    double green = 0.0;
    double blue = 0.0;
    double alpha = 1.0;
};

inline constexpr Colour paper{1.0, 1.0, 1.0};
inline constexpr Colour ink{0.16, 0.16, 0.18};
inline constexpr Colour faint_ink{0.42, 0.42, 0.45};

struct Box {
    double x = 0.0;
    double y = 0.0;
    double width = 0.0;
    double height = 0.0;
    double right() const { return x + width; }
    double bottom() const { return y + height; }
};

/// Makes a picture of width × height pixels [1, 32000]: calls fill to draw on white.
/// \return equal bytes for equal drawings (no date, no process-wide counters)
/// \throws IoError when Cairo reports a failure
Picture paint(double width, double height, Format format, std::function<void(Cairo*)> const& fill);

void set_colour(Cairo* sheet, Colour colour);
void fill_box(Cairo* sheet, Box box, Colour colour);
void frame_box(Cairo* sheet, Box box, double line_width, Colour colour);
void draw_line(Cairo* sheet, Vec2 from, Vec2 to, double line_width, Colour colour);

/// What lies far off the sheet, at a million pixels.
Vec2 near_sheet(Vec2 p);

/// Appends a polyline to the path. Vertices closer than a quarter pixel to the previous one are dropped; corners are
/// rounded within corner_px of their vertex. Coordinates far outside the sheet are clamped to 1e6 px.
void trace_line(Cairo* sheet, std::vector<Vec2> const& line, double corner_px);

/// Fills the area between a line and a height on the sheet, and draws the line on top.
void draw_ground(Cairo* sheet, std::vector<Vec2> const& line, double base_y, Colour fill, Colour colour,
                 double line_width);

enum class Anchor : std::uint8_t { start, middle, end };
enum class Weight : std::uint8_t { normal, bold };
enum class Slant : std::uint8_t { upright, italic };

struct TextStyle {
    double size = 12.0; ///< [px]
    Colour colour = ink;
    Weight weight = Weight::normal;
    double halo_px = 0.0; ///< of a white rim
    Slant slant = Slant::upright;
};

/// Accepts any bytes: invalid UTF-8 becomes U+FFFD, control characters become spaces.
double text_width(Cairo* sheet, std::string_view text, TextStyle const& style);
/// at: position of the anchor on the base line. along: direction of the base line.
void draw_text(Cairo* sheet, Vec2 at, std::string_view text, TextStyle const& style, Anchor anchor = Anchor::start,
               Vec2 along = {1.0, 0.0});
/// Joins texts by " · " in as few lines as hold them.
/// \param room [px] width of a line; a text wider than that has a line to itself
std::vector<std::string> lines_within(std::vector<std::string> const& texts, TextStyle const& style, double room);
/// As draw_text; a text wider than room is scaled down to 0.6 of its size at most, then truncated with "…".
void draw_text_within(Cairo* sheet, Vec2 at, std::string_view text, TextStyle style, double room,
                      Anchor anchor = Anchor::start);

/// The area that a map shows, and its frame on the sheet.
struct Window {
    Box frame;             ///< [px]
    double west = 0.0;     ///< [m] of the frame's left side
    double north = 0.0;    ///< [m] of the frame's upper side
    double px_per_m = 1.0; ///< > 0

    Vec2 at(Vec2 ground) const {
        return {frame.x + (ground.x - west) * px_per_m, frame.y + (north - ground.y) * px_per_m};
    }
    Vec2 ground(Vec2 place) const {
        return {west + (place.x - frame.x) / px_per_m, north - (place.y - frame.y) / px_per_m};
    }
    double east() const { return west + frame.width / px_per_m; }
    double south() const { return north - frame.height / px_per_m; }
};

// Scales, ticks and axes of the pictures.

/// Round numbers (1, 2 or 5 times a power of ten apart) in an interval of a scale.
struct Ticks {
    std::vector<double> values; ///< ascending
    double step = 1.0;
    int decimals = 0; ///< enough to distinguish the values
};

/// The largest of 1, 2, 5 times a power of ten that is at most value. value: positive and finite.
double round_down(double value);

/// Places ticks inside [low, high].
/// \return at most most + 1 ticks; one value when low = high
Ticks ticks_between(double low, double high, int most);

/// Formats a number with this number of decimals, U+2212 for minus, a thin space between thousands from 10 000; four
/// digits and an exponent from 1e9.
std::string number(double value, int decimals);

/// Formats a number as the report page does: a thin space between thousands, U+2212 for minus, no zeros at the end.
/// \param digits [1, 15] significant ones, at least; at most six decimals
std::string figures(double value, int digits);

/// Number of decimals [0, 9] that multiples of step need.
int decimals_of(double step);

/// A diagram in its box: x to the right, y up.
struct Plot {
    Box box; ///< [px]
    double x_low = 0.0;
    double x_high = 1.0;
    double y_low = 0.0;
    double y_high = 1.0;

    Vec2 at(double x, double y) const {
        return {box.x + (x - x_low) / (x_high - x_low) * box.width,
                box.bottom() - (y - y_low) / (y_high - y_low) * box.height};
    }
};

/// Extends the scale of y to round numbers, and empty scales to an interval.
void settle_scales(Plot& plot);

/// Draws grid lines, ticks with numbers, and names of the axes. unit: [px] size of a small letter, the base of all
/// lengths.
void draw_axes(Cairo* sheet, Plot const& plot, std::string const& x_name, std::string const& y_name, double unit);

} // namespace thalweg::draw
