// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/map.hpp>
#include <thalweg/draw/map.hpp>

namespace thalweg::draw {

// Numbers on a map: heights beside summits and on contours.

/// A turned rectangle [px].
struct Slab {
    Vec2 centre;
    Vec2 along{1.0, 0.0}; ///< unit vector
    double half_length = 0.0;
    double half_height = 0.0;

    std::array<Vec2, 4> corners() const;
};

/// Whether two rectangles have points in common.
bool overlap(Slab const& a, Slab const& b);

/// A text in its place.
struct Label {
    std::string text;
    TextStyle style;
    Slab room; ///< that nothing else may enter
};

struct Labels {
    std::vector<Label> heights;  ///< of summits
    std::vector<Label> contours; ///< in gaps of these lines
    std::vector<Slab> marks;     ///< of summits, by heights
};

/// Places labels so that they keep apart from one another, the frame and, on contours, rivers and shores: heights of
/// summits first, by their importance, then those of index contours, on gentle and straight stretches first. None is
/// upside down.
/// \param canvas measures texts
/// \param lines of the sheet
Labels place_labels(Cairo* canvas, MapSheet const& sheet, Window const& window, LinesOnSheet const& lines,
                    double contour_interval_m, double unit);

/// Draws summits and labels.
void draw_labels(Cairo* canvas, Labels const& labels);

} // namespace thalweg::draw
