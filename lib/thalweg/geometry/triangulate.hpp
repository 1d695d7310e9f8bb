// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/core/vec.hpp>

// Idea: Of all triangulations of points Delaunay's has the largest least angle: no point lies in
// the circumcircle of a triangle. Breaklines (rivers, ridges) must be edges, so they constrain it,
// and the rest stays as close to Delaunay as they allow. Lines are first cut at their exact
// crossings; rounding a crossing bends its lines by less than an ulp, now and then across another
// line, so that cutting repeats until nothing crosses. Ties (four points on a circle) are broken by
// the points, not by the order in which they came.
// Source: CGAL: exact predicates, spatial sorting, symbolic perturbation.
// Cost: about O(n log n) for n vertices, besides the search for crossings. One thread.
// Not for: a DEM, whose cells would all become vertices (tin_of_dem.hpp picks few). Long thin
// triangles stay where points are far from breaklines; no points are added but at crossings.
// Example:
//     std::vector<Vec3> const river = {{10.0, 10.0, 1.0}, {80.0, 80.0, 0.0}};
//     Triangulation const mesh = triangulate(points, {river});
//     Tin const& tin = mesh.tin; // surface/tin/rasterise_tin.hpp draws it

namespace thalweg::geometry {

/// A triangulation and the positions of its input in it.
struct Triangulation {
    Tin tin;
    std::vector<std::uint32_t> vertex_of_point;     ///< by point
    std::vector<std::vector<std::uint32_t>> chains; ///< by breakline: its vertices, joined by edges
    std::int64_t merged = 0;                        ///< points and line vertices at the position of an earlier one
    double merged_dz_m = 0.0;                       ///< largest difference in height of two merged
    std::int64_t crossings = 0;                     ///< vertices added where breaklines cross
    double crossings_dz_m = 0.0;                    ///< largest difference in height of the lines there
};

/// Triangulates points by constrained Delaunay triangulation: each segment of a breakline is an edge or a chain of
/// edges. At one position in plan the first counts, points before breaklines. Where breaklines cross a vertex is added,
/// its height interpolated along the first; a line through a vertex takes its height.
/// \param points finite, coordinates within 1e15 m
/// \param breaklines finite, coordinates within 1e15 m
/// \return vertices in input order: points, line vertices, added ones; triangles as put_in_order() leaves them. Of four
/// points on a circle the diagonal does not depend on input order.
/// \throws BadInput when a coordinate is not finite, fewer than three positions remain, or all are collinear
///
/// Source: CGAL, exact predicates, spatial sorting, symbolic perturbation.
Triangulation triangulate(std::vector<Vec3> const& points, std::vector<std::vector<Vec3>> const& breaklines = {},
                          Run const& run = {});

} // namespace thalweg::geometry
