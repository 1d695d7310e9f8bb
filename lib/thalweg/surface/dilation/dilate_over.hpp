// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>
#include <thalweg/surface/dilation/dilate.hpp>

namespace thalweg::surface {

/// Draws the surface E = base + H(d): slopes rise from a land laid through the valley instead of from its cells.
/// \param valley [m] heights of the river cells
/// \param base of the valley's frame, heights there are not read in valley cells; inside: as for dilate
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return valley cells exact; every other cell its base and the increments of its distance to the valley; NaN where
/// the base has no height or no dilation came. A base without steps leaves none where two valleys' slopes meet.
/// \throws Error as dilate
/// \throws BadInput when the base has another frame
///
/// Source: specification 0.4, base = harmonic.
Dilated dilate_over(Valley const& valley, Raster<float> const& base, DilateParams const& params = {},
                    Run const& run = {});
Dilated dilate_over(Valley const& valley, Raster<float> const& base, Mask const& inside,
                    DilateParams const& params = {}, Run const& run = {});

} // namespace thalweg::surface
