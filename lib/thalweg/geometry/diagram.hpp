// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/vec.hpp>

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

} // namespace thalweg::geometry
