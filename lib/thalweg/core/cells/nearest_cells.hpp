// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// Index of the marked cell nearest to each cell, by exact Euclidean distance in cells.
/// Takes: a mask with at least one cell that is not 0.
/// Gives: squared distances are compared as integers; of equally near cells the one with the lowest index.
/// Source: Meijster, Roerdink & Hesselink 2000, with the tie made part of the order.
Raster<std::int64_t> nearest_cells(Mask const& marked, Run const& run);

} // namespace thalweg
