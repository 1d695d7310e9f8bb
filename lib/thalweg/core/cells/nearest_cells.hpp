// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// Index of the marked cell nearest to each cell, by exact Euclidean distance in cells.
/// \param marked a mask with at least one cell that is not 0
/// \param run progress, log, stop token and number of threads
/// \return squared distances are compared as integers; of equally near cells the one with the lowest index.
///
/// Source: \cite meijster2000, with the tie made part of the order.
Raster<std::int64_t> nearest_cells(Mask const& marked, Run const& run);

} // namespace thalweg
