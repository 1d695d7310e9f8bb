// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

struct FloorParams {
    double width_km = 0.0; ///< half width of a floor where 1 km² drains
    double cell_m = 1.0;
    std::uint64_t seed = 0;
};

/// Lowers the cap on slopes beside rivers, so that floors form that widen downstream: flat, with a concave foot as wide
/// again. The order of cells is lost: its memory is wanted.
void valley_floors(LandLevel& level, FloorParams const& params);

} // namespace thalweg::surface
