// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/internal/drawn_lines.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/geometry/polylines.hpp>

namespace thalweg::studio {
namespace {

/// A line without vertices where it hardly turns. Simplified in pieces, because the time would grow with the square of
/// the length of a scribble.
DrawnLine simplify_line(DrawnLine const& line, double tolerance_m) {
    constexpr std::size_t piece = 2048;
    DrawnLine result;
    for (std::size_t first = 0; first + 1 < line.size(); first += piece) {
        std::size_t const last = std::min(first + piece, line.size() - 1);
        auto const begin = line.begin() + static_cast<std::ptrdiff_t>(first);
        DrawnLine const part =
            geometry::simplify(DrawnLine(begin, line.begin() + static_cast<std::ptrdiff_t>(last) + 1), tolerance_m);
        result.insert(result.end(), part.begin() + (result.empty() ? 0 : 1), part.end());
    }
    return result;
}

/// A freehand line without its tremor, simplified and rounded. Its ends stay.
DrawnLine smooth_line(DrawnLine const& line, double cell_m) {
    constexpr double reach_cells = 2.5;      // of the mean, to each side
    constexpr double tolerance_cells = 0.25; // the line may lie that far from the stroke
    DrawnLine const places = resample_line(line, sampling_cells * cell_m);
    DrawnLine result(places.size());
    auto const reach = static_cast<std::size_t>(reach_cells / sampling_cells);
    for (std::size_t i = 0; i < places.size(); ++i) { // narrower towards the ends, which stay
        std::size_t const wide = std::min({reach, i, places.size() - 1 - i});
        Vec2 sum;
        for (std::size_t k = i - wide; k <= i + wide; ++k) {
            sum = sum + places[k];
        }
        result[i] = 1.0 / static_cast<double>(2 * wide + 1) * sum;
    }
    return round_line(simplify_line(result, tolerance_cells * cell_m));
}

/// \throws NotDrawn for too many or too few points, and for those that are not finite
DrawnLine clip_stroke(Grid const& grid, DrawnLine points) {
    constexpr std::size_t most = 100000;
    constexpr double most_cells = 50000.0;
    if (points.size() > most) {
        throw NotDrawn("studio.drawn", fmt::format("a line has at most {} points", most));
    }
    for (Vec2& p : points) {
        refuse_step_if(!is_finite(p), "a place that is not a number");
        p = clip_to_grid(grid, p);
    }
    points = remove_repeats(std::move(points));
    refuse_step_if(points.size() < 2, "a line has two places at least",
                   points.empty() ? std::nullopt : std::optional(points.front()));
    if (length_of(points) > most_cells * grid.cell_m) {
        throw NotDrawn("studio.drawn", fmt::format("a line is at most {:.0f} cells long; draw it in parts", most_cells),
                       points.front());
    }
    return points;
}

} // namespace

Vec2 clip_to_grid(Grid const& grid, Vec2 p) {
    constexpr double step_m = 1e-6;
    Vec2 q = rounded(Vec2{std::clamp(p.x, grid.west, grid.east()), std::clamp(p.y, grid.south(), grid.north)});
    q.x = q.x > grid.east() ? rounded(q.x - step_m) : q.x < grid.west ? rounded(q.x + step_m) : q.x;
    q.y = q.y > grid.north ? rounded(q.y - step_m) : q.y < grid.south() ? rounded(q.y + step_m) : q.y;
    return q;
}

DrawnLine round_line(DrawnLine line) {
    std::ranges::transform(line, line.begin(), [](Vec2 p) { return rounded(p); });
    return remove_repeats(std::move(line));
}

DrawnLine resample_line(DrawnLine const& line, double every_m) {
    DrawnLine places;
    for (std::size_t i = 1; i < line.size(); ++i) {
        auto const steps =
            std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(distance(line[i - 1], line[i]) / every_m)));
        for (std::int64_t k = 0; k < steps; ++k) {
            double const share = static_cast<double>(k) / static_cast<double>(steps);
            places.push_back(line[i - 1] + share * (line[i] - line[i - 1]));
        }
    }
    places.push_back(line.back());
    return places;
}

DrawnLine longest_part_in_grid(Grid const& grid, DrawnLine const& points) {
    DrawnLine longest;
    DrawnLine part;
    for (std::size_t i = 0; i <= points.size(); ++i) {
        bool const is_in = i < points.size() && clip_to_grid(grid, points[i]) == rounded(points[i]);
        if (is_in && part.empty() && i > 0) {
            part.push_back(clip_to_grid(grid, points[i - 1]));
        }
        if (is_in) {
            part.push_back(points[i]);
        } else if (!part.empty()) {
            if (i < points.size()) {
                part.push_back(clip_to_grid(grid, points[i]));
            }
            longest = length_of(part) > length_of(longest) ? part : longest;
            part.clear();
        }
    }
    return longest;
}

DrawnLine line_from_stroke(Grid const& grid, DrawnLine points) {
    DrawnLine line = smooth_line(clip_stroke(grid, std::move(points)), grid.cell_m);
    if (line.size() < 2 || length_of(line) < least_length_cells * grid.cell_m) {
        throw NotDrawn("studio.drawn", fmt::format("this line is shorter than {} cells", least_length_cells),
                       line.front());
    }
    return line;
}

DrawnLine ring_from_stroke(Grid const& grid, DrawnLine const& points) {
    DrawnLine line = clip_stroke(grid, points);
    line.push_back(line.front());
    line = smooth_line(line, grid.cell_m);
    require_area(line, grid.cell_m);
    require_no_loop(line, true, grid.cell_m);
    line.pop_back();
    return line;
}

void snap_end(DrawnLine& line, Vec2 at, double cell_m) {
    while (line.size() > 2 && distance(line[line.size() - 2], at) < cell_m) {
        line.erase(line.end() - 2);
    }
    line.back() = at;
}

geometry::SegmentIndex index_segments(DrawnLine const& line) {
    std::vector<std::pair<Vec2, Vec2>> segments;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        segments.emplace_back(line[i], line[i + 1]);
    }
    return geometry::SegmentIndex(segments);
}

geometry::SegmentIndex index_places(DrawnLine const& places) {
    std::vector<std::pair<Vec2, Vec2>> segments;
    for (Vec2 const p : places) {
        segments.emplace_back(p, p);
    }
    return geometry::SegmentIndex(segments);
}

bool segments_cross(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    double const ca = cross(c, d, a);
    double const cb = cross(c, d, b);
    double const ac = cross(a, b, c);
    double const ad = cross(a, b, d);
    bool const is_cut = (ca < 0.0 && cb > 0.0) || (ca > 0.0 && cb < 0.0);
    return is_cut && ((ac < 0.0 && ad > 0.0) || (ac > 0.0 && ad < 0.0));
}

void require_no_loop(DrawnLine const& line, bool is_closed, double cell_m) {
    double const near_m = touching_cells * cell_m;
    std::size_t const segments = line.size() - 1;
    auto const meet = [&](std::size_t i, std::size_t k) {
        if (is_closed && i == 0 && k + 1 == segments) {
            return false; // it ends where it begins
        }
        return (k > i + 1 && segments_cross(line[i], line[i + 1], line[k], line[k + 1])) ||
               distance_to_segment(line[i], line[i + 1], line[k + 1]) < near_m ||
               distance_to_segment(line[k], line[k + 1], line[i]) < near_m;
    };
    geometry::SegmentIndex const index = index_segments(line);
    for (std::size_t k = 1; k < segments; ++k) {
        for (std::size_t const i : index.near(line[k], line[k + 1], near_m)) {
            refuse_step_if(i < k && meet(i, k), "the line crosses itself here", line[k]);
        }
    }
}

void require_area(DrawnLine const& line, double cell_m) {
    constexpr double least_cells = 9.0;
    if (line.size() < 4 || std::fabs(geometry::signed_area(line)) < least_cells * cell_m * cell_m) {
        throw NotDrawn("studio.drawn", fmt::format("this area has fewer than {} cells", least_cells), line.front());
    }
}

} // namespace thalweg::studio
