// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <thalweg/fractal/refine.hpp>

namespace thalweg::fractal {

/// Weights and deviations of one level, as its points want them.
class LevelWeights {
public:
    LevelWeights(Refinement const& refinement, int level);

    /// For points with all their neighbours.
    struct Simple {
        float middle = 0.0F;
        float farthest = 0.0F;
        std::array<double, 2> deviation{}; ///< in units of sigma, of centres and of edges
    };
    /// Where H is the same everywhere.
    Simple const& simple() const { return simple_; }
    /// step: H in steps of Character::steps_of_hurst.
    Simple const& simple(float step) const { return by_step_[static_cast<std::size_t>(step)]; }

    /// sigma r^H per sigma; r: distance of the nearest neighbours in coarse cells.
    double reach(double hurst, bool edge) const;

private:
    Simple at_hurst(double hurst) const;

    Refinement const& refinement_;
    double side_; ///< [coarse cells] of the finer lattice
    Simple simple_;
    std::vector<Simple> by_step_;
};

} // namespace thalweg::fractal
