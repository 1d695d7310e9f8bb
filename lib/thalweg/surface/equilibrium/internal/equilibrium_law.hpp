// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/area_power.hpp>

/// Private to this module.
namespace thalweg::surface {

/// U + D lap z = K A^theta S in the solver's units: lengths, heights and areas in cells of the finest level, U 1 where
/// nothing is said, and K such that slopes where hardly anything drains are the same at any cell size: far from what
/// floats can lose.
struct EquilibriumLaw {
    EquilibriumLaw(EquilibriumParams const& params, double cell_m)
        : EquilibriumLaw(params, cell_m, incision(params, cell_m)) {}

    AreaPower power;      ///< K A^theta, of the given rivers
    AreaPower land_power; ///< of the land: below the area of debris flows these cut as well, and slopes hardly change
                          ///< with it any more (Stock and Dietrich 2003)
    float creep;          ///< D, by the length below which creep wins (Perron 2009)
    float source_area;    ///< [finest cells] that a drawn source drains already

private:
    EquilibriumLaw(EquilibriumParams const& params, double cell_m, double k)
        : power(params.theta, 0.0, k), land_power(params.theta, debris_cells(params, cell_m), k),
          creep(static_cast<float>(
              k * portable::pow(std::min(params.hillslope_m / cell_m, most_creep), 2.0 * params.theta + 1.0))),
          source_area(static_cast<float>(source_area_m2 / (cell_m * cell_m))) {}

    static double debris_cells(EquilibriumParams const& params, double cell_m) {
        return params.debris_area_m2 / (cell_m * cell_m);
    }
    static double incision(EquilibriumParams const& params, double cell_m) {
        constexpr double of_one_cell = 4.7; // times less than uplift: slopes of heads are a good half of the cap
        return of_one_cell / static_cast<double>(AreaPower(params.theta, debris_cells(params, cell_m))(1.0F));
    }

    static constexpr double most_creep = 100.0; // [finest cells]: beyond, rounds do not suffice
    static constexpr double source_area_m2 = 90'000.0;
};

} // namespace thalweg::surface
