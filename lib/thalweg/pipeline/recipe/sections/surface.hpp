// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/flow/condition.hpp>
#include <thalweg/pipeline/recipe/sections/equilibrium.hpp>
#include <thalweg/skeleton/regress.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/dilation/dilation.hpp>

namespace thalweg::pipeline {

enum class Method : std::uint8_t { equilibrium, dilate, diffuse, tin, regress };

enum class Base : std::uint8_t { harmonic, paper, tin };

enum class Interpolation : std::uint8_t { linear, natural };

/// The keys of section [surface] of a recipe.
struct SurfaceRecipe {
    Method method = Method::equilibrium;
    EquilibriumRecipe equilibrium;
    Base base = Base::harmonic;
    surface::DilateParams dilate;
    surface::DiffuseParams diffuse;
    std::string mask; ///< raster on the grid: cells with 0 or no data are left out; "" for none
    Interpolation interpolation = Interpolation::linear; ///< of a TIN
    std::optional<double> tolerance;                     ///< (0, 0.1] of a solution; none: that of each method
    skeleton::RegressParams regress;
    std::optional<flow::Conditioning> drain; ///< none: carve where there are rivers, else flow::Conditioning::none
};

} // namespace thalweg::pipeline
