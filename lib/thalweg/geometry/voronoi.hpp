// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/geometry/diagram.hpp>

namespace thalweg::geometry {

/// Voronoi diagram of the vertices of lines: the edges that keep labels apart.
/// \pre lines in any place, of one vertex or more; vertices at one place are one site with the labels of all its lines.
/// \param lines the polylines
/// \param bounds the box that bounds the diagram
/// \param run progress, log, stop token and number of threads
/// \return edges whose points are as near to their two sites as to any; no edges where fewer than two labels are.
/// Vertices nearer to one another than 1e-9 of everything's size are one. Edges that share a point share a vertex,
/// unless they cross by less than that.
/// \throws BadInput naming the vertex when one is not finite
/// \throws BadParameter when bounds have no area
/// \throws Cancelled
///
/// Source: Voronoi 1908; CGAL, Delaunay triangulation with exact predicates.
Diagram voronoi(std::vector<LabelledLine> const& lines, Bounds const& bounds, Run const& run = {});

} // namespace thalweg::geometry
