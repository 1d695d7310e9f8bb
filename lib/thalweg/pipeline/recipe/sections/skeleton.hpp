// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/skeleton/scatter.hpp>

namespace thalweg::pipeline {

/// What ridges lie midway between: points along the rivers, or the rivers themselves.
enum class Ridges : std::uint8_t { none, voronoi, segments };

/// What else the surface must honour.
struct SkeletonRecipe {
    Ridges ridges = Ridges::none;
    double ridge_gain = 0.3;             ///< [m/m] >= 0, lambda: rise above the rivers by distance from them
    double ridge_farthest_m = 0.0;       ///< [m] >= 0, d_max: distance beyond which they rise no more; 0: none
    double ridge_noise_m = 0.0;          ///< [m] >= 0, amplitude of noise along them
    double ridge_wavelength_m = 1000.0;  ///< [m] > 0, of its longest waves
    double midpoint_inverse_cells = 0.0; ///< [cells] >= 0, L: cells beside the skeleton that follow from it; 0: none
    std::string points;                  ///< file of points with heights; "" for none
    std::int64_t scatter = 0;            ///< points at random; 0 for none
    double spacing_cells = 0.0;          ///< [cells] least distance of points at random
    skeleton::HeightLaw law = skeleton::HeightLaw::uniform;
    skeleton::Deviation deviation = skeleton::Deviation::exact; ///< of points at random
    skeleton::Falloff falloff = skeleton::Falloff::literal;     ///< of their pull to the extremes
    bool tin = false;                                           ///< write the skeleton's TIN
};

} // namespace thalweg::pipeline
