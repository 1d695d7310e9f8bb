// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/area_power.hpp>

/// Private to this module.
namespace thalweg::surface {

/// U + D lap z = K A^theta S in the solver's units: lengths, heights and areas in cells of the finest level, U and K 1
/// where nothing is said.
struct EquilibriumLaw {
    EquilibriumLaw(EquilibriumParams const& params, double cell_m)
        : power(params.theta), land_power(params.theta, params.debris_area_m2 / (cell_m * cell_m)),
          creep(static_cast<float>(
              portable::pow(std::min(params.hillslope_m / cell_m, most_creep), 2.0 * params.theta + 1.0))),
          source_area(static_cast<float>(source_area_m2 / (cell_m * cell_m))),
          steepest(above_heads / land_power(1.0F)) {}

    static constexpr double most_creep = 100.0; ///< [finest cells]: beyond, rounds do not suffice
    static constexpr double source_area_m2 = 90'000.0;
    static constexpr float above_heads = 1.4F;

    AreaPower power;      ///< A^theta, of the given rivers
    AreaPower land_power; ///< of the land: below this area debris flows cut as well, and slopes hardly change with it
                          ///< any more (Stock and Dietrich 2003)
    float creep;          ///< D, by the length below which creep wins (Perron 2009)
    float source_area;    ///< [finest cells] that a drawn source drains already
    float steepest;       ///< tangent that uplift keeps up in rock of the common erodibility: some above that of heads
};

} // namespace thalweg::surface
