// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace thalweg::surface {

/// A roughness of terrain in equilibrium, and how gradients are correlated with it.
struct TextureMatch {
    double roughness = 0.0;   ///< [0, 0.88] as EquilibriumParams
    double correlation = 0.0; ///< [-1, 1] of unit gradients at some distance
};

/// Searches the roughness with which the gradients of terrain are correlated as wanted, by secants from the slope that
/// was measured in Big Tujunga and Jacksboro: at most three more terrains.
/// \param first the terrain that is there
/// \param wanted [-1, 1] correlation
/// \param correlation_with makes the terrain with another roughness and measures it
/// \return the last one made: within 0.01 of wanted, or where roughness reaches no further
TextureMatch match_texture(TextureMatch const& first, double wanted,
                           std::function<double(double roughness)> const& correlation_with);

} // namespace thalweg::surface
