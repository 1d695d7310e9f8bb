// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// Finds the nearest marked cell of every cell, by exact Euclidean distance.
/// \param marked at least one cell is not 0
/// \param run progress, log, stop token and number of threads
/// \return by cell: index of the nearest marked cell; of several equally near, the lowest
///
/// Source: \cite meijster2000, with a total order for ties.
Raster<std::int64_t> nearest_cells(Mask const& marked, Run const& run);

} // namespace thalweg
