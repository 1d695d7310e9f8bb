// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>

/// Land from numbers and from points (paper 001). Private to this module.
namespace thalweg::pipeline {

/// The check points_missing: random points that found no room, with a warning.
Check points_missing(std::int64_t missing, std::int64_t wanted, Run const& run);

/// Land without rivers: a random one or that of points, with fractal detail, brought to the statistics.
Terrain make_land(Plan const& plan, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
