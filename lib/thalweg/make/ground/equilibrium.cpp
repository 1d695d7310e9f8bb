// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/internal/balance.hpp>

// Described in docs/equilibrium.md.

namespace thalweg::make {

Surface equilibrium(GroundInput const& in, Run const& run) {
    auto const solve = [&](Channels const& channels, surface::EquilibriumFields const& fields,
                           surface::EquilibriumParams const& params) {
        return SolvedEquilibrium{surface::equilibrium(channels, fields, params, run), params};
    };
    return balanced(in, {.solve = solve}, run);
}

} // namespace thalweg::make
