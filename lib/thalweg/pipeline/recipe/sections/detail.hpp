// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/fractal/midpoint.hpp>

namespace thalweg::pipeline {

enum class DetailMethod : std::uint8_t { none, midpoint };

/// The keys of section [detail] of a recipe.
struct DetailRecipe {
    DetailMethod method = DetailMethod::midpoint;
    fractal::MidpointParams midpoint;
};

} // namespace thalweg::pipeline
