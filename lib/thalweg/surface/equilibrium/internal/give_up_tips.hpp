// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Shortens rivers by the cells that stand perched near their heads, and what lies upstream of these. What is given up
/// becomes land; where banks stay, none that would lie below a river beside it. Gives: numbers in the caller's
/// Channels.
enum class TipBanks : std::uint8_t { stay, rise };
std::vector<std::int64_t> give_up_tips(LandLevel& level, float tangent, TipBanks banks);

/// The same for the cells near heads that lie beside cells of another river: there no land between them fits.
std::vector<std::int64_t> give_up_touching_tips(LandLevel& level);

} // namespace thalweg::surface
