// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>

namespace thalweg::surface {

/// Options of harmonic().
struct HarmonicParams {
    double tolerance = 1e-8; ///< (0, 1) as in solver::PoissonParams
};

/// Interpolates a valley's heights by Laplace's equation (five-point stencil, no flux across the border): a base for
/// dilate_over, so that E = base + H(d) is smooth where the heights of rivers differ. With `inside`, a mask in the
/// valley's frame, nothing flows across cells of 0, and valley cells there do not count.
/// \param valley [m] heights of river cells
/// \param run progress, log, stop token and number of threads
/// \return valley cells bit for bit; others between their lowest and highest, to within the tolerance times the largest
/// |height| before rounding to float; NaN outside and in parts without valley cells
/// \throws BadInput for no valley cell (inside), an infinite height, or a mask in another frame
/// \throws BadParameter when the tolerance is outside its range
/// \throws NotConverged when the solver does not reach the tolerance
/// \throws Cancelled
///
/// Source: specification 0.4.
Raster<float> harmonic(Valley const& valley, Run const& run = {});
Raster<float> harmonic(Valley const& valley, Mask const& inside, Run const& run = {});
Raster<float> harmonic(Valley const& valley, Mask const& inside, HarmonicParams const& params, Run const& run = {});

} // namespace thalweg::surface
