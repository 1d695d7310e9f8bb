// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/studio/drawing.hpp>
#include <thalweg/studio/internal/drawn_lines.hpp>

// Rivers in a drawing: where they meet, and what keeps them apart.
namespace thalweg::studio {

/// A place on a river.
struct RiverSpot {
    std::size_t river = no_number;
    std::size_t segment = 0;
    Vec2 at;
    double distance_m = infinite; ///< from where it was searched
};

/// The place on one river nearest to p, if it is nearer than another spot, else that spot.
RiverSpot nearest_on_river(Drawing const& drawing, std::size_t river, Vec2 p, RiverSpot nearest = {});

/// The nearest place on rivers within reach.
/// \param left_out river that is not searched
RiverSpot nearest_on_rivers(Drawing const& drawing, Vec2 p, std::size_t left_out, double reach_m);

/// Adds a vertex to a river, unless there is one within the clearance.
/// \return the place of the vertex
Vec2 add_vertex(Drawing& drawing, RiverSpot const& spot);

struct RiverVertex {
    std::size_t river = no_number;
    std::size_t vertex = 0;
};

/// By river: the vertex of another river where it flows into that one. None for outlets.
std::vector<RiverVertex> downstream_vertices(Drawing const& drawing);

/// Whether water from one river reaches another. A river reaches itself.
/// \param below as downstream_vertices()
bool flows_through(std::vector<RiverVertex> const& below, std::size_t from, std::size_t through);

/// Whether another river has a vertex at a place.
bool meets_other_river(Drawing const& drawing, std::size_t river, Vec2 at);

/// Rivers, where each that begins at the ends of others is one with the longest of these.
std::vector<DrawnRiver> merge_successive_rivers(Drawing const& drawing);

/// Checks a river between two vertices.
/// \throws NotDrawn where it lies in the sea, touches a ridge, crosses another river or comes nearer to one than
/// clear_cells, except towards where they meet
void require_clear(Drawing const& drawing, std::size_t river, std::size_t first, std::size_t last, double clear_cells);

/// \throws NotDrawn where rivers flow in a circle
void require_no_circle(Drawing const& drawing);

} // namespace thalweg::studio
