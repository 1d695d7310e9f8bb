// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::solver {

/// Consecutive cells of one row.
struct CellSpan {
    std::int64_t row = 0;
    std::int64_t begin = 0; ///< first column
    std::int64_t end = 0;   ///< one past the last column
};

/// Finds the free cells not connected (by 4-neighbours that are not outside) to a fixed cell: Laplace's equation has no
/// unique solution there.
/// \param kind CellKind by cell
/// \param run progress, log, stop token and number of threads
/// \return each such cell in one span; spans in row order
std::vector<CellSpan> unreached(Raster<std::uint8_t> const& kind, Run const& run = {});

} // namespace thalweg::solver
