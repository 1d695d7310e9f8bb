// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/diagram.hpp>
#include <thalweg/geometry/natural_neighbours.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/geometry/tin_of_dem.hpp>
#include <thalweg/geometry/triangles.hpp>
#include <thalweg/geometry/triangulate.hpp>
