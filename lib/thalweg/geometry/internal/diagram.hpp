// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>

#include <thalweg/core/run/run.hpp>
#include <thalweg/geometry/diagram.hpp>

namespace thalweg::geometry {

/// The point equally far from three sites of a segment Voronoi diagram, a guess made better.
/// Takes: sites that lie near the origin in terms of their distances, counterclockwise; a guess not far off, or one
/// that is not finite.
/// Gives: the point at which the distances agree best, the guess itself where nothing better is found.
/// Source: Newton's method; in closed form where a site is an end of another.
Vec2 equidistant(std::array<Diagram::Site, 3> const& sites, Vec2 guess);

/// Points between p and q on the curve equally far from two sites: a parabola where one is a point and one a segment,
/// which chords between the points leave by at most the tolerance; a straight line, without points, elsewhere.
/// Of the parabola only what is nearer than farthest_m to the sites is drawn so finely.
std::vector<Vec2> curve_between(Diagram::Site const& s, Diagram::Site const& t, Vec2 p, Vec2 q, double tolerance_m,
                                double farthest_m);

/// The places of lines, each once, with the labels of all lines through it: what a diagram is made of.
struct LabelledSites {
    std::vector<Diagram::Site> sites;
    std::vector<std::vector<std::int64_t>> labels; ///< by site, ascending
    std::vector<std::array<std::size_t, 2>> ends;  ///< by segment, which follow the points: its points
    std::size_t points = 0;                        ///< the sites before the segments
    std::array<Vec2, 4> far;                       ///< points around all sites and the bounds, far from them
    double size_m = 0.0;                           ///< diagonal of all sites and the bounds
};

/// Takes: segments, whether the lines' segments count or only their vertices. Throws: BadInput naming a vertex that is
/// not finite; BadParameter when the bounds have no area.
enum class Parts : std::uint8_t { vertices, segments };
LabelledSites sites_of(std::vector<LabelledLine> const& lines, Bounds const& bounds, Parts parts,
                       std::string const& what);

/// The sites around a face counterclockwise, the least first, and which of the face's vertices that is. CGAL's meshes
/// keep faces, and say which vertex of a face is the first, by where in memory they lie.
struct Around {
    std::array<std::size_t, 3> sites{};
    int first = 0;
};
Around least_first(std::array<std::size_t, 3> const& sites);

/// A diagram before its vertices are merged and its edges are cut: by face of its dual.
struct RawDiagram {
    struct Link {
        std::size_t from = 0; ///< face
        std::size_t to = 0;   ///< face
        std::size_t left = 0;
        std::size_t right = 0;
    };
    std::vector<Vec2> at;                          ///< by face
    std::vector<std::array<std::size_t, 3>> sites; ///< by face; numbers beyond the sites are far points
    std::vector<Link> links;                       ///< all pairs of neighbouring faces, in any order
};

using Curve = std::function<std::vector<Vec2>(Diagram::Site const&, Diagram::Site const&, Vec2, Vec2)>;

/// Merges vertices that rounding alone keeps apart, leaves out edges between sites with a label in common, and cuts
/// the others at the bounds. curve: the points between the ends of an edge.
Diagram finish(LabelledSites const& sites, RawDiagram raw, Bounds const& bounds, Curve const& curve, Run const& run);

} // namespace thalweg::geometry
