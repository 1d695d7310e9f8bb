// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {

/// A lake that no river leaves.
struct LakeWithoutOutflow {
    std::int64_t lake;
    Vec2 at;
    std::int64_t rivers;
    Vec2 next; ///< where a river begins beside it
    double next_m;
    Vec2 out = nowhere; ///< where its water leaves it
};

/// A river that leaves a lake besides its outflow, as drawn.
struct SecondOutflow {
    std::int64_t lake;
    std::int64_t river;
    Vec2 at;
};

/// A river that ends below the lake that it reaches.
struct RiverBelowLake {
    std::int64_t river;
    Vec2 at;
    double by_m;
};

/// What these may mean, at most one finding a kind.
std::vector<Finding> findings_of_lakes(std::vector<LakeWithoutOutflow> const& closed,
                                       std::vector<RiverBelowLake> const& low,
                                       std::vector<SecondOutflow> const& second);

} // namespace thalweg::network::import_steps
