// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/network/planform/internal/segment_grid.hpp>

namespace thalweg::network {

/// Area of a ring [m2], whichever way it runs.
double area_of(std::vector<Vec2> const& ring);

/// Middle of a ring's vertices [m], weighted by the area.
Vec2 centroid_of(std::vector<Vec2> const& ring);

/// Whether a place lies inside a ring (even-odd rule; on the ring itself either answer may come).
bool contains(std::vector<Vec2> const& ring, Vec2 p);

/// The sides of a ring.
std::vector<Segment> sides_of(std::vector<Vec2> const& ring);

/// The places of a square lattice of this width that lie inside a ring, row by row.
std::vector<Vec2> lattice_in(std::vector<Vec2> const& ring, double width_m);

} // namespace thalweg::network
