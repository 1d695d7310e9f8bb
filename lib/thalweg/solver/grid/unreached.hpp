// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::solver {

/// Neighbouring cells of one row.
struct CellSpan {
    std::int64_t row = 0;
    std::int64_t begin = 0; ///< first column
    std::int64_t end = 0;   ///< past the last column
};

/// The free cells from which no path through 4-neighbours that are not outside leads to a fixed cell: where Laplace's
/// equation has no one solution.
/// \param kind a CellKind a cell
/// \param run progress, log, stop token and number of threads
/// \return each such cell in one span, the spans from the north-west on.
std::vector<CellSpan> unreached(Raster<std::uint8_t> const& kind, Run const& run = {});

} // namespace thalweg::solver
