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

/// What every picture is drawn with: a sheet in memory, colours, lines and text. Private to this module.
/// Lengths on a sheet are pixels, x to the right, y down.
namespace thalweg::draw {

using Cairo = ::_cairo;

struct Colour {
    double red = 0.0; ///< [0, 1], as the others
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

/// A picture of width × height pixels [1, 32000] that fill draws on white.
/// Gives: equal bytes for equal drawing (no date, no counters of the process).
/// Throws: IoError when Cairo reports a failure.
Picture paint(double width, double height, Format format, std::function<void(Cairo*)> const& fill);

void set_colour(Cairo* sheet, Colour colour);
void fill_box(Cairo* sheet, Box box, Colour colour);
void frame_box(Cairo* sheet, Box box, double line_width, Colour colour);
void draw_line(Cairo* sheet, Vec2 from, Vec2 to, double line_width, Colour colour);

/// Appends a polyline to the path. Vertices nearer than a quarter pixel to the last one are left out; corners are
/// rounded within corner_px of their vertex. Coordinates far outside any sheet are drawn no further than 1e6 px away.
void trace_line(Cairo* sheet, std::vector<Vec2> const& line, double corner_px);

enum class Anchor : std::uint8_t { start, middle, end };
enum class Weight : std::uint8_t { normal, bold };

struct TextStyle {
    double size = 12.0; ///< [px]
    Colour colour = ink;
    Weight weight = Weight::normal;
    double halo_px = 0.0; ///< of a white rim
};

/// Any bytes: what is not UTF-8 becomes U+FFFD, control characters become spaces.
double text_width(Cairo* sheet, std::string_view text, TextStyle const& style);
/// at: where the anchor stands on the base line. along: the direction of its base line.
void draw_text(Cairo* sheet, Vec2 at, std::string_view text, TextStyle const& style, Anchor anchor = Anchor::start,
               Vec2 along = {1.0, 0.0});
/// As draw_text; a text wider than room is set smaller, down to 0.6 of its size, then cut and ended by "…".
void draw_text_within(Cairo* sheet, Vec2 at, std::string_view text, TextStyle style, double room,
                      Anchor anchor = Anchor::start);

} // namespace thalweg::draw
