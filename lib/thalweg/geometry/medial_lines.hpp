// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/required.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/geometry/diagram.hpp>

namespace thalweg::geometry {

/// Options of medial_lines().
struct MedialLinesParams {
    Required<double> tolerance_m; ///< [m] > 0, largest distance of chords from a parabola
};

/// Computes the segment Voronoi diagram of lines: the medial lines between labels, arcs of parabolas as chords.
/// \param lines meet only at common vertices; a common segment has the labels of both
/// \param bounds clips the diagram
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return vertices of edges are equally far from their two sites, which are the nearest; no edges for fewer than two
/// labels. Otherwise as voronoi().
/// \throws BadInput naming the position where lines meet elsewhere or a vertex is not finite
/// \throws BadParameter when the tolerance is not above 0 or bounds have no area
/// \throws Cancelled
///
/// Source: \cite karavelas2004, A robust and efficient implementation for the segment Voronoi diagram; CGAL, exact
/// predicates.
Diagram medial_lines(std::vector<LabelledLine> const& lines, Bounds const& bounds, MedialLinesParams const& params,
                     Run const& run = {});

} // namespace thalweg::geometry
