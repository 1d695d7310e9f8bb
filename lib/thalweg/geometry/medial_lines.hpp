// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/required.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/geometry/diagram.hpp>

namespace thalweg::geometry {

struct MedialLinesParams {
    Required<double> tolerance_m; ///< [m] > 0, how far chords may leave a parabola
};

/// Segment Voronoi diagram of lines: the exact lines midway between labels.
/// Takes: lines that meet only in vertices of both; a repeated vertex counts once, a segment of two lines has the
/// labels of both. Gives: edges all whose vertices are equally far from their two sites, which are the nearest; arcs of
/// parabolas as chords; no edges where fewer than two labels are. Otherwise like voronoi().
/// Throws: BadInput naming the place when lines meet elsewhere or a vertex is not finite; BadParameter; Cancelled.
/// Source: Karavelas 2004, A robust and efficient implementation for the segment Voronoi diagram; CGAL, exact
/// predicates.
Diagram medial_lines(std::vector<LabelledLine> const& lines, Bounds const& bounds, MedialLinesParams const& params,
                     Run const& run = {});

} // namespace thalweg::geometry
