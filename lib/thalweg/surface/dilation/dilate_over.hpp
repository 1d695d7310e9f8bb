// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>
#include <thalweg/surface/dilation/dilate.hpp>

namespace thalweg::surface {

/// Builds the surface E = base + H(d), whose slopes rise from a base surface instead of from valley cells. With
/// `inside` as dilate.
/// \param valley [m] heights of river cells
/// \param base [m] by cell, in the valley's frame, e.g. harmonic(valley); not read in valley cells
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return valley cells bit for bit; NaN where base is NaN or no dilation reaches. A smooth base leaves no step between
/// the slopes of two valleys.
/// \throws Error as dilate
/// \throws BadInput when the base has another frame
///
/// Source: specification 0.4, base = harmonic.
Dilated dilate_over(Valley const& valley, Raster<float> const& base, DilateParams const& params = {},
                    Run const& run = {});
Dilated dilate_over(Valley const& valley, Raster<float> const& base, Mask const& inside,
                    DilateParams const& params = {}, Run const& run = {});

} // namespace thalweg::surface
