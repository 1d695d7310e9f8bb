// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// A polyline all whose places bear one label. Lines of one label belong together.
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

/// What keeps the regions of labels apart: those edges of a Voronoi diagram whose two sites have no label in common,
/// within bounds.
struct Diagram {
    /// A vertex of a line (a == b), or the segment that begins at it.
    struct Site {
        std::size_t line = 0;   ///< the first line it is found in
        std::size_t vertex = 0; ///< of that line
        Vec2 a;
        Vec2 b;
    };
    /// A vertex of the diagram.
    struct Vertex {
        Vec2 at;                        ///< [m]
        std::vector<std::size_t> sites; ///< those it is equally far from, ascending; two where bounds end an edge
    };
    /// An edge of the diagram.
    struct Edge {
        std::size_t from = 0;   ///< vertex
        std::size_t to = 0;     ///< vertex
        std::size_t left = 0;   ///< site on the left, seen from `from`
        std::size_t right = 0;  ///< site on the right
        std::vector<Vec2> line; ///< [m] from the one vertex to the other, both included
    };
    std::vector<Site> sites;
    std::vector<Vertex> vertices;
    std::vector<Edge> edges;
};

/// \param site the site
/// \param p [m] a position
/// \return distance from p to a site [m].
double distance_to(Diagram::Site const& site, Vec2 p);

/// \pre a place near to such a point.
/// \param s the first site
/// \param t the second site
/// \param p [m] a place near such a point
/// \param direction direction of the line; (0, 0): across the distances
/// \return the point equally far from two sites on the straight line through p along a direction, or across their
/// distances where that is (0, 0).
///
/// Source: Newton's method.
Vec2 midway(Diagram::Site const& s, Diagram::Site const& t, Vec2 p, Vec2 direction = {});

} // namespace thalweg::geometry
