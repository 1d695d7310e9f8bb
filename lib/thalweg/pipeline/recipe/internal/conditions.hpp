// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/pipeline/recipe/internal/key_use.hpp>

/// Conditions that keys of several sections share: what the stages read, and when. Private to this module.
namespace thalweg::pipeline {

Use source_is(char const* word);

/// Terrain around rivers by one of these methods.
Use method_is(std::vector<std::string> const& words);
Use by_equilibrium();
Use by_dilation();
/// Around rivers, or between points.
Use by_diffusion();

/// Around rivers by a method that honours ridges and points.
Use beside_rivers();

/// Terrain that is interpolated between points, in a file or random.
Use from_points();

Use has_surface();

/// Heights of the highest or lowest cell are given.
Use has_extremes();

} // namespace thalweg::pipeline
