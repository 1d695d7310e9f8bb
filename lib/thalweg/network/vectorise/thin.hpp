// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

/// Thins a mask to its skeleton.
/// \param mask 0: outside, as is everything beyond the grid
/// \param run progress, log, stop token and number of threads
/// \return a subset one cell wide with as many components (8-connected) and holes (4-connected) as the mask, without
/// L-shaped corners; thinning again changes nothing. Four branches may meet in a block of 2 x 2 cells.
/// \throws Cancelled
///
/// Source: \cite guo1989, algorithm A1, 64 cells a word.
Mask thin(Mask const& mask, Run const& run = {});

} // namespace thalweg::network
