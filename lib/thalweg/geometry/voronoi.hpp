// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/geometry/diagram.hpp>

namespace thalweg::geometry {

/// Computes the Voronoi diagram of the vertices of lines: the edges between labels.
/// \param lines at least one vertex each; coincident vertices are one site with the labels of all their lines
/// \param bounds clips the diagram
/// \param run progress, log, stop token and number of threads
/// \return points of edges are nearest to their two sites; no edges for fewer than two labels. Vertices closer than
/// 1e-9 of the whole extent are merged; edges that share a point share a vertex, unless they cross by less than that.
/// \throws BadInput naming the vertex when one is not finite
/// \throws BadParameter when bounds have no area
/// \throws Cancelled
///
/// Source: Voronoi 1908; CGAL, Delaunay triangulation with exact predicates.
Diagram voronoi(std::vector<LabelledLine> const& lines, Bounds const& bounds, Run const& run = {});

} // namespace thalweg::geometry
