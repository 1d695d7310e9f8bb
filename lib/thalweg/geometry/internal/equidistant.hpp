// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include <thalweg/geometry/diagram.hpp>

/// Private to this module.
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

} // namespace thalweg::geometry
