// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/area_power.hpp>

/// Private to this module.
namespace thalweg::surface {

/// U + D lap z = K A^theta S in the solver's units: lengths, heights and areas in cells of the finest level, U and K 1
/// where nothing is said.
struct EquilibriumLaw {
    explicit EquilibriumLaw(EquilibriumParams const& params)
        : power(params.theta), land_power(params.theta, debris_area),
          creep(static_cast<float>(portable::pow(params.hillslope_cells, 2.0 * params.theta + 1.0))) {}

    static constexpr double debris_area = 16.0; ///< [finest cells]

    AreaPower power;      ///< A^theta, of the given rivers
    AreaPower land_power; ///< of the land: below this area debris flows cut as well, and slopes hardly change with it
                          ///< any more (Stock and Dietrich 2003)
    float creep;          ///< D, by the length below which creep wins (Perron 2009)
};

} // namespace thalweg::surface
