// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/segment_grid.hpp>

namespace thalweg::geometry {

double squared_distance(Segment const& s, Segment const& t) {
    double const ta = cross(s.a, s.b, t.a);
    double const tb = cross(s.a, s.b, t.b);
    double const sa = cross(t.a, t.b, s.a);
    double const sb = cross(t.a, t.b, s.b);
    if (((ta < 0.0) != (tb < 0.0)) && ((sa < 0.0) != (sb < 0.0))) {
        return 0.0;
    }
    return std::min(std::min(squared_distance(s.a, t), squared_distance(s.b, t)),
                    std::min(squared_distance(t.a, s), squared_distance(t.b, s)));
}

SegmentGrid::SegmentGrid(Vec2 low, Vec2 high, double cell_m, std::size_t count)
    : low_(low), cell_m_(std::max(cell_m, std::max(high.x - low.x, high.y - low.y) / 2000.0)),
      width_(static_cast<std::size_t>(std::floor((high.x - low.x) / cell_m_)) + 1),
      height_(static_cast<std::size_t>(std::floor((high.y - low.y) / cell_m_)) + 1), cells_(width_ * height_),
      segments_(count), held_(count, 0), seen_(count, 0) {}

void SegmentGrid::add(std::size_t number, Segment const& s) {
    segments_[number] = s;
    held_[number] = 1;
    Span const span = span_of(s, 0.0);
    for (std::size_t row = span.first_row; row <= span.last_row; ++row) {
        for (std::size_t col = span.first_col; col <= span.last_col; ++col) {
            cells_[row * width_ + col].push_back(static_cast<std::uint32_t>(number));
        }
    }
}

void SegmentGrid::remove(std::size_t number) {
    held_[number] = 0;
    Span const span = span_of(segments_[number], 0.0);
    for (std::size_t row = span.first_row; row <= span.last_row; ++row) {
        for (std::size_t col = span.first_col; col <= span.last_col; ++col) {
            auto& cell = cells_[row * width_ + col];
            auto const at = std::find(cell.begin(), cell.end(), static_cast<std::uint32_t>(number));
            *at = cell.back();
            cell.pop_back();
        }
    }
}

} // namespace thalweg::geometry
