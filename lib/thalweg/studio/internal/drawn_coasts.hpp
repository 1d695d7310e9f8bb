// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/studio/drawing.hpp>
#include <thalweg/studio/internal/drawn_lines.hpp>

// Land and sea in a drawing.
namespace thalweg::studio {

/// What a place has for its nearest coast.
struct NearestCoast {
    Vec2 at; ///< on the coast
    double distance_m = infinite;
    bool is_land = true; ///< the place lies at the left of the coast, or there is no coast
};

/// Coasts in short stretches, for many searches. The coasts must outlive it. No geometry::SegmentIndex: that would be
/// ten times slower here, because most searches are close to the last one.
class CoastIndex {
public:
    explicit CoastIndex(std::vector<DrawnLine> const& coasts);

    bool empty() const { return coasts_.empty(); }

    /// Fast where places that follow one another are close together. Where two segments are equally near, that one
    /// decides whose straight line is farther from the place.
    NearestCoast nearest(Vec2 p);

private:
    /// Successive segments of a coast, and the corners of the box around them.
    struct Stretch {
        std::size_t coast;
        std::size_t begin;
        std::size_t end;
        Vec2 low;
        Vec2 high;
    };

    std::vector<DrawnLine> const& coasts_;
    std::vector<Stretch> stretches_;
    Vec2 last_; ///< the place of the last search
    double last_m_ = infinite;
};

/// The nearest place on the border of the grid.
Vec2 nearest_on_border(Grid const& grid, Vec2 p);

/// Whether a place lies in the sea, and not on the coast itself.
bool lies_in_sea(NearestCoast const& coast, double cell_m);
bool lies_in_sea(Drawing const& drawing, Vec2 p);

/// The longest part of a stroke in the grid and on land, with messages on what is left out.
/// \param what "river"
DrawnLine line_on_land(DrawResult& result, DrawnLine const& points, char const* what);

/// \throws NotDrawn where a line crosses or touches a coast
void require_apart_from_coasts(Drawing const& drawing, DrawnLine const& line);

/// Removes from every river what lies in the sea, with a message.
void cut_rivers_at_coasts(DrawResult& result);

} // namespace thalweg::studio
