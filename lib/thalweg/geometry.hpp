// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Lines and points → intersections, TINs, Voronoi diagrams, medial lines.
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/diagram.hpp>
#include <thalweg/geometry/natural_neighbours.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/geometry/segment_grid.hpp>
#include <thalweg/geometry/tin_of_dem.hpp>
#include <thalweg/geometry/triangles.hpp>
#include <thalweg/geometry/triangulate.hpp>
