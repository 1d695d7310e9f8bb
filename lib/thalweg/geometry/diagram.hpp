// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

// Idea: The Voronoi diagram divides the plane by the nearest site; its edges are equally far from
// two sites. Sites are the vertices of lines, or whole segments: then edges are the exact medial
// lines, straight where two lines or two points face each other, parabolas between a point and a
// line. Only edges between different labels are kept: those are divides between rivers. The diagram
// is the dual of a (segment) Delaunay triangulation, whose combinatorial structure comes from exact
// predicates; positions of the vertices of medial lines are refined by Newton steps until they are
// equally far from their three sites. Faces are put in order by their sites, since CGAL orders them
// by memory address.
// Source: Voronoi 1908; Karavelas 2004 (segment Voronoi diagram); CGAL.
// Cost: about O(n log n) for n sites, which are inserted along a space-filling curve. One thread.
// Not for: lines that cross away from their vertices: medial_lines refuses them, voronoi takes them
// as points. Points along a line approximate its medial line only as closely as they are spaced.
// Example:
//     std::vector<LabelledLine> const rivers = {{{{0.0, 0.0}, {90.0, 400.0}}, 1},
//                                               {{{300.0, 0.0}, {200.0, 400.0}}, 2}};
//     Bounds const box{.west = 0.0, .south = 0.0, .east = 400.0, .north = 500.0};
//     Diagram const divides = medial_lines(rivers, box, {.tolerance_m = 1.0});
// More: skeleton/ridges.hpp gives these lines heights.

namespace thalweg::geometry {

/// A polyline with a label; lines of one label belong together.
struct LabelledLine {
    std::vector<Vec2> line; ///< [m]
    std::int64_t label = 0;
};

/// A rectangle in plan.
struct Bounds {
    double west = 0.0;  ///< [m]
    double south = 0.0; ///< [m]
    double east = 0.0;  ///< [m] > west
    double north = 0.0; ///< [m] > south
};

/// The edges of a Voronoi diagram, within bounds, whose two sites have no common label.
struct Diagram {
    /// A vertex of a line (a == b), or the segment that begins at it.
    struct Site {
        std::size_t line = 0;   ///< the first line with this site
        std::size_t vertex = 0; ///< of that line
        Vec2 a;
        Vec2 b;
    };
    /// A vertex of the diagram.
    struct Vertex {
        Vec2 at;                        ///< [m]
        std::vector<std::size_t> sites; ///< equally far from it, ascending; two: the bounds end an edge here
    };
    /// An edge of the diagram.
    struct Edge {
        std::size_t from = 0;   ///< vertex
        std::size_t to = 0;     ///< vertex
        std::size_t left = 0;   ///< site to the left
        std::size_t right = 0;  ///< site to the right
        std::vector<Vec2> line; ///< [m] from the one vertex to the other, both included
    };
    std::vector<Site> sites;
    std::vector<Vertex> vertices;
    std::vector<Edge> edges;
};

/// The distance of a point from a site.
/// \param site a vertex or segment
/// \param p [m]
/// \return [m]
double distance_to(Diagram::Site const& site, Vec2 p);

/// Finds a point equally far from two sites, on the line through p.
/// \param s,t sites
/// \param p [m] near such a point
/// \param direction of the line; (0, 0): the gradient of the difference of distances
/// \return [m]
///
/// Source: Newton's method.
Vec2 midway(Diagram::Site const& s, Diagram::Site const& t, Vec2 p, Vec2 direction = {});

/// Computes the Voronoi diagram of the vertices of lines: the edges between labels.
/// \param lines at least one vertex each; coincident vertices are one site with the labels of all their lines
/// \param bounds clips the diagram
/// \return points of edges are nearest to their two sites; no edges for fewer than two labels. Vertices closer than
/// 1e-9 of the whole extent are merged; edges that share a point share a vertex, unless they cross by less than that.
/// \throws BadInput naming the vertex when one is not finite
/// \throws BadParameter when bounds have no area
///
/// Source: Voronoi 1908; CGAL, Delaunay triangulation with exact predicates.
Diagram voronoi(std::vector<LabelledLine> const& lines, Bounds const& bounds, Run const& run = {});

/// Options of medial_lines().
struct MedialLinesParams {
    Required<double> tolerance_m; ///< [m] > 0, largest distance of chords from a parabola
};

/// Computes the segment Voronoi diagram of lines: the medial lines between labels, arcs of parabolas as chords.
/// \param lines meet only at common vertices; a common segment has the labels of both
/// \param bounds clips the diagram
/// \return vertices of edges are equally far from their two sites, which are the nearest; no edges for fewer than two
/// labels. Otherwise as voronoi().
/// \throws BadInput naming the position where lines meet elsewhere or a vertex is not finite
/// \throws BadParameter when the tolerance is not above 0 or bounds have no area
///
/// Source: \cite karavelas2004, A robust and efficient implementation for the segment Voronoi diagram; CGAL, exact
/// predicates.
Diagram medial_lines(std::vector<LabelledLine> const& lines, Bounds const& bounds, MedialLinesParams const& params,
                     Run const& run = {});

} // namespace thalweg::geometry
