// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/internal/drawn_lines.hpp>

#include <thalweg/geometry/nearby.hpp>

namespace thalweg::network {

namespace {

constexpr double same_cells = 1e-3; ///< places as near are one
// The nearest line is looked for within these, doubling, so that few segments are looked at.
constexpr double first_reach_cells = 1.5;
constexpr double last_reach_cells = 12.0;

std::size_t segments_of(StreamNetwork const& plan) {
    std::size_t segments = 0;
    for (ArcId arc = 0; arc < plan.arc_count(); ++arc) {
        segments += plan.arc(arc).line.size() - 1;
    }
    return segments;
}

} // namespace

DrawnLines::DrawnLines(StreamNetwork const& plan, Grid const& grid)
    : plan_(plan), cell_m_(grid.cell_m),
      segments_({grid.west, grid.south()}, {grid.east(), grid.north}, 4.0 * grid.cell_m, segments_of(plan)) {
    for (std::size_t a = 0; a < plan.arc_count(); ++a) {
        std::vector<Vec2> const& line = plan.arc(a).line;
        for (std::size_t k = 0; k + 1 < line.size(); ++k) {
            segments_.add(owners_.size(), {line[k], line[k + 1]});
            owners_.emplace_back(a, k);
        }
    }
}

bool DrawnLines::come_near(Segment const& s, double margin_cells) const {
    double const margin = margin_cells * cell_m_;
    return !segments_.near(s, margin,
                           [&](std::size_t n) { return squared_distance(segments_[n], s) > margin * margin; });
}

std::optional<PlaceOnArc> DrawnLines::nearest(Vec2 p) const {
    for (double reach = first_reach_cells; reach <= last_reach_cells; reach *= 2.0) {
        double best = reach * cell_m_;
        std::optional<std::size_t> found;
        segments_.near({p, p}, best, [&](std::size_t n) {
            double const d = distance(p, geometry::foot_on(segments_[n].a, segments_[n].b, p).at);
            if (d < best || (d == best && found && owners_[n] < owners_[*found])) {
                best = d;
                found = n;
            }
            return true;
        });
        if (found) {
            auto const [arc, segment] = owners_[*found];
            geometry::Foot const foot = geometry::foot_on(segments_[*found].a, segments_[*found].b, p);
            return settled({arc, segment, foot.along, foot.at});
        }
    }
    return std::nullopt;
}

PlaceOnArc DrawnLines::settled(PlaceOnArc place) const {
    std::vector<Vec2> const& line = plan_.arc(place.arc).line;
    double const near = same_cells * cell_m_;
    if (distance(place.at, line[place.segment + 1]) <= near) {
        return {place.arc, place.segment + 1, 0.0, line[place.segment + 1]};
    }
    return distance(place.at, line[place.segment]) <= near
               ? PlaceOnArc{place.arc, place.segment, 0.0, line[place.segment]}
               : place;
}

} // namespace thalweg::network
