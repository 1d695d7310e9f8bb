// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/elementary.hpp>
#include <thalweg/surface/area_power.hpp>
#include <thalweg/surface/equilibrium.hpp>

/// Private to this room.
namespace thalweg::surface {

/// U + D lap z = K A^theta S in the solver's units: lengths, heights and areas in cells of the finest level, U and K 1
/// where nothing is said.
struct EquilibriumLaw {
    explicit EquilibriumLaw(EquilibriumParams const& params)
        : power(params.theta), creep(static_cast<float>(exact::pow(params.hillslope_cells, 2.0 * params.theta + 1.0))) {
    }

    AreaPower power; ///< A^theta
    float creep;     ///< D, by the length below which creep wins (Perron 2009)
};

} // namespace thalweg::surface
