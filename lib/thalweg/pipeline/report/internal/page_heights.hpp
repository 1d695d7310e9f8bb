// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::pipeline {

/// Heights as the report page reads them (web/README.md).
struct PageHeights {
    std::int64_t width = 0;          ///< [values]
    std::int64_t height = 0;         ///< [values]
    std::int64_t cells = 1;          ///< [cells] a value is the mean of a square of cells x cells
    double min = 0.0;                ///< [m] of the values
    double max = 0.0;                ///< [m] likewise
    std::int64_t nodata = 0;         ///< values without a height
    std::vector<std::uint8_t> bytes; ///< predictors, low bytes, high bytes
};

/// Side [cells] of the squares that the page shows by one value each.
/// Gives: the smallest with which no side of the grid has more than 4096 values, and the whole not more than 1 500 000.
std::int64_t page_cells(Grid const& grid);

/// The means of a DEM's squares in 16 bits, each row against the predictor that leaves the shortest residuals.
/// Takes: heights, NaN for none: these are left out of means, and a square of them has no value. Gives: nothing when no
/// cell has a height; otherwise values within (max - min) / 131068 of the means, exactly min where all are alike.
/// Throws: BadInput: an infinite height; Cancelled.
std::optional<PageHeights> page_heights(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::pipeline
