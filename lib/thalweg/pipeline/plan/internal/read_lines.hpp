// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

/// The lines that a recipe names, and what follows from them. Private to this module.
namespace thalweg::pipeline {

/// The lines of network.lines.path.
RiverLines read_lines(Recipe const& recipe, Run const& run);

/// A recipe with the CRS and, where it is 0, the cell size of its grid by its lines; and a mean slope by the cell size.
struct OnLines {
    Recipe recipe;
    std::string why; ///< the cell has its size, as the end of a sentence; "" where it was given
};
OnLines settle_on_lines(Recipe recipe, RiverLines const& lines, Run const& run);

/// The usual mean slope [degrees] of land in cells of this size: the coarser, the gentler. Within 6 % of the mean
/// slopes of Big Tujunga averaged to cells of 75 to 1200 m.
double usual_slope_deg(double cell_m);

} // namespace thalweg::pipeline
