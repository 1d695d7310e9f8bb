// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/planform/internal/segment_grid.hpp>

namespace thalweg::network {

/// A place on a given arc.
struct PlaceOnArc {
    std::size_t arc = 0;
    std::size_t segment = 0;
    double along = 0.0; ///< [0, 1) on the segment
    Vec2 at;

    friend bool operator<(PlaceOnArc const& a, PlaceOnArc const& b) {
        return std::tie(a.arc, a.segment, a.along) < std::tie(b.arc, b.segment, b.along);
    }
};

/// The drawn lines of given rivers, to find what is near.
class DrawnLines {
public:
    DrawnLines(StreamNetwork const& plan, Grid const& grid);

    bool come_near(Segment const& s, double margin_cells) const;

    /// The place nearest to p (ties: the first); none within a few cells.
    std::optional<PlaceOnArc> nearest(Vec2 p) const;

private:
    /// The place moved to the vertex it is next to.
    PlaceOnArc settled(PlaceOnArc place) const;

    StreamNetwork const& plan_;
    double cell_m_;
    SegmentGrid segments_;
    std::vector<std::pair<std::size_t, std::size_t>> owners_; ///< by segment: arc and segment of it
};

} // namespace thalweg::network
