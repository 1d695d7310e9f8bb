// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/make/internal/ground.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

// Described in docs/equilibrium.md.

namespace thalweg::make {

/// A terrain in equilibrium.
struct SolvedEquilibrium {
    surface::EquilibriumTerrain land;
    surface::EquilibriumParams params = {}; ///< with which it was solved for
    Rebuilt told = {};                      ///< by rivers with heights of a file
    std::vector<Finding> findings = {};
};

/// What tells grounds in equilibrium apart.
struct Balance {
    bool is_rebuilt = false; ///< from rivers with heights of a file
    /// Solves for the land once.
    std::function<SolvedEquilibrium(Channels const& channels, surface::EquilibriumFields const& fields,
                                    surface::EquilibriumParams const& params)>
        solve;
};

/// Makes a surface in equilibrium with rivers, cuts their perched tips and gives them their heights from it. Heights
/// that rivers have because their lines have them give way where they would need walls.
Surface balanced(GroundInput const& in, Balance const& balance, Run const& run);

} // namespace thalweg::make
