// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/geometry/cotangents.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/diagram.hpp>
#include <thalweg/geometry/height_on_plane.hpp>
#include <thalweg/geometry/medial_lines.hpp>
#include <thalweg/geometry/meetings.hpp>
#include <thalweg/geometry/natural_neighbours.hpp>
#include <thalweg/geometry/point_grid.hpp>
#include <thalweg/geometry/segments_near.hpp>
#include <thalweg/geometry/side_of_line.hpp>
#include <thalweg/geometry/tin_of_dem.hpp>
#include <thalweg/geometry/triangle_order.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/geometry/voronoi.hpp>
