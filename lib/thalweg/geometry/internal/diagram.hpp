// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>

#include <thalweg/core/run/run.hpp>
#include <thalweg/geometry/diagram.hpp>

namespace thalweg::geometry {

/// Refines a guess of the point equally far from three sites of a segment Voronoi diagram.
/// \param sites near the origin compared with their distances, counterclockwise
/// \param guess near the point, or not finite
/// \return the point at which the distances agree best; the guess itself if no better one is found
///
/// Source: Newton's method; in closed form where a site is an end of another.
Vec2 equidistant(std::array<Diagram::Site, 3> const& sites, Vec2 guess);

/// Samples the curve between p and q equally far from two sites: a parabola for a point and a segment, from which
/// chords deviate by at most the tolerance; a straight line, without points, otherwise. Parts of the parabola farther
/// than farthest_m from the sites are sampled more coarsely.
std::vector<Vec2> curve_between(Diagram::Site const& s, Diagram::Site const& t, Vec2 p, Vec2 q, double tolerance_m,
                                double farthest_m);

/// The distinct sites of lines, with the labels of all lines through them; the input of a diagram.
struct LabelledSites {
    std::vector<Diagram::Site> sites;
    std::vector<std::vector<std::int64_t>> labels; ///< by site, ascending
    std::vector<std::array<std::size_t, 2>> ends;  ///< by segment (segments follow the points): its points
    std::size_t points = 0;                        ///< number of point sites, which precede the segments
    std::array<Vec2, 4> far;                       ///< points far outside all sites and the bounds
    double size_m = 0.0;                           ///< diagonal of all sites and the bounds
};

/// Collects the sites of lines: vertices alone, or segments too.
/// \throws BadInput naming a vertex that is not finite
/// \throws BadParameter when the bounds have no area
enum class Parts : std::uint8_t { vertices, segments };
LabelledSites sites_of(std::vector<LabelledLine> const& lines, Bounds const& bounds, Parts parts,
                       std::string const& where);

/// The sites around a face counterclockwise, the least first, and the position of that one among the face's vertices.
/// CGAL orders faces and their vertices by memory address, which is not reproducible.
struct Around {
    std::array<std::size_t, 3> sites{};
    int first = 0;
};
Around least_first(std::array<std::size_t, 3> const& sites);

/// A diagram before vertices are merged and edges clipped, by face of its dual.
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

/// Merges vertices that only rounding separates, drops edges between sites with a common label, and clips the others to
/// the bounds. curve: samples an edge between its ends.
Diagram finish(LabelledSites const& sites, RawDiagram raw, Bounds const& bounds, Curve const& curve, Run const& run);

} // namespace thalweg::geometry
