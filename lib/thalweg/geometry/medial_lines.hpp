// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/required.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/geometry/diagram.hpp>

namespace thalweg::geometry {

/// Options of medial_lines().
struct MedialLinesParams {
    Required<double> tolerance_m; ///< [m] > 0, how far chords may leave a parabola
};

/// Segment Voronoi diagram of lines: the exact lines midway between labels.
/// \pre lines that meet only in vertices of both; a repeated vertex counts once, a segment of two lines has the labels
/// of both.
/// \param lines the polylines
/// \param bounds the box that bounds the diagram
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return edges all whose vertices are equally far from their two sites, which are the nearest; arcs of parabolas as
/// chords; no edges where fewer than two labels are. Otherwise like voronoi().
/// \throws BadInput naming the place when lines meet elsewhere or a vertex is not finite
/// \throws BadParameter
/// \throws Cancelled
///
/// Source: \cite karavelas2004, A robust and efficient implementation for the segment Voronoi diagram; CGAL, exact
/// predicates.
Diagram medial_lines(std::vector<LabelledLine> const& lines, Bounds const& bounds, MedialLinesParams const& params,
                     Run const& run = {});

} // namespace thalweg::geometry
