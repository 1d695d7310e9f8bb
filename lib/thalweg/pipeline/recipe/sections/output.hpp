// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/io/network/schema.hpp>

namespace thalweg::pipeline {

/// The keys of section [output] of a recipe.
struct OutputRecipe {
    std::string title;                      ///< of the pictures and the page; "" names the seed
    double contour_interval = 0.0;          ///< [units] 0 chooses a round number
    bool catchments = true;                 ///< of the arcs, where there are rivers and a surface
    bool accumulation = false;              ///< contributing areas by cell, where there is a surface
    io::Schema schema = io::Schema::native; ///< another one: a network file more, in its words
    HeightUnit units = HeightUnit::metre;   ///< of heights in dem.tif, networks, contours and TINs
};

} // namespace thalweg::pipeline
