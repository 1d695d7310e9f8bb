// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include <thalweg/core/channels.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>

// The caller's rivers, and what both solvers of levels have in common. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// Rounds at the finest level before valley floors are formed: areas have settled by then.
inline constexpr int floors_after = 2;

/// The share of all work that is done at a round of a level, which takes a quarter of the time of the next finer one.
double share_done(std::size_t number, int round, int rounds);

/// \throws BadInput as equilibrium()
void check_rivers(Channels const& rivers, EquilibriumFields const& fields);
/// \throws BadInput where there are layers of rock
/// \param with what they cannot be combined with
/// \param instead what to do
void refuse_layers(EquilibriumFields const& fields, char const* with, char const* instead);
/// Whether lakes have levels.
bool has_levels(Channels const& rivers);
/// Prescribed heights that follow the levels of lakes: not below those downstream, below those upstream. Ends stay.
Channels with_levels(Channels rivers);

} // namespace thalweg::surface
