// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// A triangulation, and where what was handed in is found in it.
struct Triangulation {
    Tin tin;
    std::vector<std::uint32_t> vertex_of_point;     ///< by point
    std::vector<std::vector<std::uint32_t>> chains; ///< by breakline: the vertices it runs through, joined by edges
    std::int64_t merged = 0;                        ///< points and line vertices that lie where an earlier one does
    double merged_dz_m = 0.0;                       ///< greatest difference of height between such two
    std::int64_t crossings = 0;                     ///< vertices added where breaklines cross
    double crossings_dz_m = 0.0;                    ///< greatest difference of the lines' heights there
};

/// Delaunay triangulation of points, constrained by breaklines: each of their segments is an edge or a chain of edges.
/// \pre points and breaklines in any order, finite, coordinates within 1e15 m. Where several lie at the same place in
/// plan the first stands: points before breaklines, in their order. Where breaklines cross away from any vertex one is
/// added, its height interpolated along the first of them; a line that runs through a vertex takes its height.
/// \param points the points
/// \param breaklines lines that triangles do not cross
/// \param run progress, log, stop token and number of threads
/// \return vertices in the order of the input, points, then line vertices, then added ones; triangles as put_in_order()
/// has them. Four points on a circle take the same diagonal in any order of the input.
/// \throws BadInput when something is not finite, fewer than three places are left, or all lie on one line
/// \throws Cancelled
///
/// Source: CGAL, exact predicates, spatial sorting, symbolic perturbation.
Triangulation triangulate(std::vector<Vec3> const& points, std::vector<std::vector<Vec3>> const& breaklines = {},
                          Run const& run = {});

} // namespace thalweg::geometry
