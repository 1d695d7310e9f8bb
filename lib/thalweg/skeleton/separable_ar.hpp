// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/skeleton/field_params.hpp>

namespace thalweg::skeleton {

/// Draws a Gaussian random field with exponential, separable correlation, by autoregression along rows and columns.
/// \param grid of the result
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return heights whose correlation at (dx, dy) cells is exp(-dx/lx) exp(-dy/ly), exact from the first cell: h(i,j) =
/// a h(i,j-1) + b h(i-1,j) - a b h(i-1,j-1) + std sqrt((1-a^2)(1-b^2)) e, a = exp(-1/lx), b = exp(-1/ly). Its fractal
/// dimension is 2.5. The same bits for any number of threads.
/// \throws BadParameter when a parameter is outside its range
/// \throws Cancelled
///
/// Source: \cite zhang, section 2 ("approximately exponential and separable").
Raster<float> separable_ar(Grid const& grid, FieldParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
