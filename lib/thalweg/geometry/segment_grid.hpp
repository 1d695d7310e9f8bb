// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

struct Segment {
    Vec2 a;
    Vec2 b;
};

/// Square of the distance between two segments [m2]; 0 where they cross.
double squared_distance(Segment const& s, Segment const& t);

/// Square of the distance of a point to a segment [m2].
inline double squared_distance(Vec2 p, Segment const& s) {
    double const dx = s.b.x - s.a.x;
    double const dy = s.b.y - s.a.y;
    double const length = dx * dx + dy * dy;
    double const along = length > 0.0 ? std::clamp(((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / length, 0.0, 1.0) : 0.0;
    double const x = p.x - s.a.x - along * dx;
    double const y = p.y - s.a.y - along * dy;
    return x * x + y * y;
}

/// An index of segments by the grid cells they pass through; segments may be moved.
class SegmentGrid {
public:
    /// Covers the box from low to high; numbers of segments lie in [0, count).
    SegmentGrid(Vec2 low, Vec2 high, double cell_m, std::size_t count);

    void add(std::size_t number, Segment const& s);
    void remove(std::size_t number);
    bool holds(std::size_t number) const { return held_[number] != 0; }
    Segment const& operator[](std::size_t number) const { return segments_[number]; }

    /// Calls visit(number) once for each segment that may be within margin_m of s, until it returns false.
    template <typename Visit> bool near(Segment const& s, double margin_m, Visit const& visit) const {
        Span const span = span_of(s, margin_m);
        ++stamp_;
        for (std::size_t row = span.first_row; row <= span.last_row; ++row) {
            for (std::size_t col = span.first_col; col <= span.last_col; ++col) {
                for (std::uint32_t const number : cells_[row * width_ + col]) {
                    if (seen_[number] != stamp_) {
                        seen_[number] = stamp_;
                        if (!visit(std::size_t{number})) {
                            return false;
                        }
                    }
                }
            }
        }
        return true;
    }

private:
    struct Span {
        std::size_t first_col;
        std::size_t last_col;
        std::size_t first_row;
        std::size_t last_row;
    };

    static std::size_t slot(double along, double cell_m, std::size_t count) {
        double const at = std::floor(along / cell_m);
        return at < 0.0 ? 0 : std::min(static_cast<std::size_t>(at), count - 1);
    }
    Span span_of(Segment const& s, double margin_m) const {
        return {slot(std::min(s.a.x, s.b.x) - margin_m - low_.x, cell_m_, width_),
                slot(std::max(s.a.x, s.b.x) + margin_m - low_.x, cell_m_, width_),
                slot(std::min(s.a.y, s.b.y) - margin_m - low_.y, cell_m_, height_),
                slot(std::max(s.a.y, s.b.y) + margin_m - low_.y, cell_m_, height_)};
    }

    Vec2 low_;
    double cell_m_;
    std::size_t width_;
    std::size_t height_;
    std::vector<std::vector<std::uint32_t>> cells_;
    std::vector<Segment> segments_;
    std::vector<std::uint8_t> held_;
    mutable std::vector<std::uint32_t> seen_;
    mutable std::uint32_t stamp_ = 0;
};

} // namespace thalweg::geometry
