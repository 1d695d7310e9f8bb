// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/measure/drainage/certificate.hpp>

namespace thalweg::measure {

/// Compares extracted cells with a river's; both lists have no duplicates.
Agreements agreement(std::vector<std::int64_t> const& found, std::vector<std::int64_t> const& rivers, Grid const& grid);

/// Tries the contributing areas 2^n and 3 * 2^n [cells] from 16. Returns the one whose cells agree best with a river's
/// within a cell (ties: the least), and the agreement; (0, nothing) if no cell has 16.
std::pair<std::int64_t, Agreements> best_threshold(Raster<flow::CellCount> const& area_cells,
                                                   std::vector<std::int64_t> const& rivers, Run const& run);

} // namespace thalweg::measure
