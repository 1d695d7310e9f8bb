// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run.hpp>

namespace thalweg::network {

/// Thins a mask to its skeleton.
/// Takes: 1 inside, 0 outside; what lies beyond the grid counts as outside.
/// Gives: an 8-connected subset one cell wide with as many components as the mask; thinning it again changes nothing.
/// Throws: Cancelled.
/// Source: Guo and Hall 1989, 64 cells a word.
Mask thin(Mask const& mask, Run const& run = {});

} // namespace thalweg::network
