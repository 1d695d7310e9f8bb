// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>

namespace thalweg::surface {

/// Options of harmonic().
struct HarmonicParams {
    double tolerance = 1e-8; ///< (0,1) as solver::PoissonParams
};

/// Base of a dilation without scarps: heights that are the mean of their neighbours' off the valley, so that E =
/// harmonic + H(d) is smooth where the rivers' own heights differ.
/// \param valley heights of the river cells. inside: of the valley's frame; cells with 0 are barriers across which
/// nothing is smoothed, and a valley cell there does not count
/// \param run progress, log, stop token and number of threads
/// \return valley cells exact; other cells between the lowest and the highest of them, to within the tolerance times
/// the greatest |height| before they are rounded to a float; NaN outside and in parts that hold no valley cell.
/// \throws BadInput no valley cell (inside), an infinite height, another frame
/// \throws BadParameter
/// \throws NotConverged
/// \throws Cancelled
///
/// Source: specification 0.4: Laplace's equation in five points, no flux across the border.
Raster<float> harmonic(Valley const& valley, Run const& run = {});
Raster<float> harmonic(Valley const& valley, Mask const& inside, Run const& run = {});
Raster<float> harmonic(Valley const& valley, Mask const& inside, HarmonicParams const& params, Run const& run = {});

} // namespace thalweg::surface
