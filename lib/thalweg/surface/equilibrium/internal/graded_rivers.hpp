// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/surface/equilibrium/internal/equilibrium_law.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Tangent of a graded river cell by the area that drains into it, not more than a share of the cap.
float graded_tangent(LandLevel const& level, EquilibriumLaw const& law, std::uint32_t i);

/// The greatest heights of river cells, by number, that leave neither them nor, within one reach, what lies upstream
/// perched above the land beside them.
std::vector<float> greatest_heights(LandLevel const& level, EquilibriumLaw const& law);

} // namespace thalweg::surface
