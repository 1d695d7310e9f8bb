// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/internal/level_weights.hpp>

#include <cmath>

#include <thalweg/core/numbers/elementary.hpp>

namespace thalweg::fractal {

LevelWeights::LevelWeights(Refinement const& refinement, int level)
    : refinement_(refinement), side_(std::ldexp(1.0, -level)) {
    if (!refinement.character.varies()) {
        simple_ = at_hurst(refinement.character.hurst);
        return;
    }
    for (int step = 0; step <= static_cast<int>(Character::steps_of_hurst); ++step) {
        // No estimate comes near 0 or 1, where there is nothing to solve.
        bool const useful = step > 0 && step < static_cast<int>(Character::steps_of_hurst);
        by_step_.push_back(useful ? at_hurst(step / Character::steps_of_hurst) : Simple{});
    }
}

double LevelWeights::reach(double hurst, bool edge) const {
    return portable::pow(edge ? side_ : side_ * std::sqrt(2.0), hurst);
}

LevelWeights::Simple LevelWeights::at_hurst(double hurst) const {
    StencilWeights const full = stencil_weights(refinement_.stencil, used_neighbours(refinement_.stencil), hurst);
    return {static_cast<float>(full.weight[4]),
            static_cast<float>(full.weight[12]),
            {full.deviation * reach(hurst, false), full.deviation * reach(hurst, true)}};
}

} // namespace thalweg::fractal
