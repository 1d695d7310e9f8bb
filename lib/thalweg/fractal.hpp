// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A coarse raster → a finer one with fractal detail; a DEM and statistics → the nearest DEM that has them.
#include <thalweg/fractal/estimate_fractal.hpp>
#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/fractal/midpoint.hpp>
