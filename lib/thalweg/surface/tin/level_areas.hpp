// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/triangulate.hpp>

// Idea: A TIN of contours has flat triangles where all three corners lie on one contour: on spurs,
// in valleys, on summits. Midpoints of the edges across such areas lie near the medial line, where
// the ridge or valley runs. Each gets a height from the contours around it: a thin-plate spline
// through the nearest vertices of up to three heights in eight directions, held within one contour
// interval. With these points the triangulation is no longer flat there.
// Source: Prasad 2007 (midpoints for the medial line); Duchon 1977 (thin-plate splines).
// Cost: for each midpoint a dense system of up to 48 samples; linear in the number of flat
// triangles. All on one thread.
// Not for: TINs that have no contours; lakes, which are flat. Heights are guesses within an
// interval.
// Example:
//     geometry::Triangulation const mesh = geometry::triangulate({}, contour_lines);
//     std::vector<Vec3> const points = medial_points(mesh); // triangulate again with these
// More: docs/commands.md, "Contours and lines".

namespace thalweg::surface {

/// Finds the share of a TIN's area in level triangles, whose corners are at one height.
/// \return [0, 1]
double level_share(Tin const& tin);

/// Finds heights inside the level areas of a TIN of contours: where all corners of triangles lie on one contour, as on
/// spurs, in valleys, on summits and passes, the TIN is cut flat. Points are the midpoints of edges across such areas,
/// and of their edges on the hull; they lie near the medial line. Each gets the height of a thin-plate spline through
/// the vertices around it, the nearest of up to three heights in each of eight directions, less than a contour interval
/// from the contour.
/// \param contours a triangulation of level lines
/// \return points in the order of the triangles; none where no other height is near. The same for any number of threads
///
/// Source: \cite prasad2007, midpoints of edges for the medial line; \cite duchon1977, thin-plate splines.
std::vector<Vec3> medial_points(geometry::Triangulation const& contours, Run const& run = {});

} // namespace thalweg::surface
