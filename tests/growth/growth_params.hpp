// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/growth/forest/grow_forest.hpp>

namespace test {

using namespace thalweg;

inline growth::ForestParams forest_params(std::int64_t step, std::uint64_t seed, double sticking = 1.0,
                                          int visits = 1) {
    growth::ForestParams params;
    params.step_cells = step;
    params.seed = seed;
    params.sticking = sticking;
    params.visits = visits;
    return params;
}

} // namespace test
