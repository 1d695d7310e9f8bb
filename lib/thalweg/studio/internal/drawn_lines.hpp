// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <thalweg/geometry/nearby.hpp>
#include <thalweg/studio/drawing.hpp>

// The geometry of drawn lines, without regard to what they stand for.
namespace thalweg::studio {

inline constexpr double snap_cells = 3.0;      ///< ends nearer than this meet
inline constexpr double clearance_cells = 1.5; ///< of a new river from others
inline constexpr double least_length_cells = 3.0;
inline constexpr double sampling_cells = 0.5;  ///< between the places where a line is tested
inline constexpr double touching_cells = 0.01; ///< lines nearer than this touch
inline constexpr double in_river_cells = 0.75; ///< pins nearer than this lie in the cells of a river

inline constexpr double infinite = std::numeric_limits<double>::infinity();
inline constexpr std::size_t no_number = std::numeric_limits<std::size_t>::max(); ///< no river, no pin

/// Orders the places in sets and maps.
struct BeforeInPlan {
    bool operator()(Vec2 a, Vec2 b) const { return before(a, b); }
};

inline void refuse_step_if(bool is_wrong, char const* words, std::optional<Vec2> at = std::nullopt) {
    if (is_wrong) {
        throw NotDrawn("studio.drawn", words, at);
    }
}

/// The nearest place in the grid with the precision of files. Rounding does not carry it over the border.
Vec2 clip_to_grid(Grid const& grid, Vec2 p);

/// Of vertices in a row at one place the first one stays.
inline DrawnLine remove_repeats(DrawnLine line) {
    line.erase(std::unique(line.begin(), line.end()), line.end());
    return line;
}

/// A line with the precision of files.
DrawnLine round_line(DrawnLine line);

/// Places along a line, at most every_m apart, vertices among them.
DrawnLine resample_line(DrawnLine const& line, double every_m);

/// The longest part of a line in the grid, carried to its border.
DrawnLine longest_part_in_grid(Grid const& grid, DrawnLine const& points);

/// A stroke in the grid, smoothed, simplified and rounded.
/// \throws NotDrawn for one that is too short or too long, and for points that are not finite
DrawnLine line_from_stroke(Grid const& grid, DrawnLine points);

/// The ring that a stroke encloses, not closed explicitly.
/// \throws NotDrawn as line_from_stroke(), require_area() and require_no_loop()
DrawnLine ring_from_stroke(Grid const& grid, DrawnLine const& points);

/// Moves the end of a line. Vertices less than a cell from the new end are left out.
void snap_end(DrawnLine& line, Vec2 at, double cell_m);

/// How far a vertex follows another one that is dragged: 1 beside it, 0 at the reach.
/// \param along_m distance between the two along the line
inline double drag_weight(double along_m, double reach_m) {
    double const share = std::min(along_m / std::max(reach_m, 1e-9), 1.0);
    return (1.0 - share * share) * (1.0 - share * share);
}

inline double distance_to_segment(Vec2 a, Vec2 b, Vec2 p) {
    return distance(geometry::foot_on(a, b, p).at, p);
}

/// An index of the segments of a line.
geometry::SegmentIndex index_segments(DrawnLine const& line);

/// An index of places, as segments of no length.
geometry::SegmentIndex index_places(DrawnLine const& places);

/// Whether two segments cross between their ends.
bool segments_cross(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

/// \throws NotDrawn where a line crosses or touches itself
void require_no_loop(DrawnLine const& line, bool is_closed, double cell_m);

/// \param line ends where it begins
/// \throws NotDrawn for a small area
void require_area(DrawnLine const& line, double cell_m);

/// Places, to find those near lines. The places must outlive it.
struct PlaceIndex {
    DrawnLine const& places;
    double near_m; ///< [m]
    geometry::SegmentIndex index = index_places(places);

    /// Calls visit(number of the place, distance in m) for each segment of a line and each place nearer to it than
    /// near_m.
    template <class Visit> void visit_near(DrawnLine const& line, Visit const& visit) const {
        for (std::size_t k = 0; k + 1 < line.size(); ++k) {
            for (std::size_t const i : index.near(line[k], line[k + 1], near_m)) {
                double const distance_m = distance_to_segment(line[k], line[k + 1], places[i]);
                if (distance_m < near_m) {
                    visit(i, distance_m);
                }
            }
        }
    }
};

/// Which places are nearer than near_m to rivers or ridges.
template <class Lines> std::vector<bool> find_near_lines(DrawnLine const& places, Lines const& lines, double near_m) {
    std::vector<bool> is_near(places.size());
    PlaceIndex const index{places, near_m};
    for (auto const& one : lines) {
        index.visit_near(one.line, [&](std::size_t place, double /*distance_m*/) { is_near[place] = true; });
    }
    return is_near;
}

/// The first place that is nearer than near_m to rivers or ridges.
template <class Lines>
std::optional<Vec2> first_near_lines(DrawnLine const& places, Lines const& lines, double near_m) {
    std::vector<bool> const is_near = find_near_lines(places, lines, near_m);
    auto const first = static_cast<std::size_t>(std::ranges::find(is_near, true) - is_near.begin());
    return first < places.size() ? std::optional(places[first]) : std::nullopt;
}

} // namespace thalweg::studio
