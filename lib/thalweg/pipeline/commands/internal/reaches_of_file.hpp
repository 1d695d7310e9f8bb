// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/flow/catchments.hpp>

/// Private to this module.
namespace thalweg::pipeline {

/// What the arcs of a network file are to the land of a DEM.
struct FileReaches {
    flow::Reaches reaches;            ///< an arc's parts in the grid
    std::vector<std::int64_t> basins; ///< by reach: that of the file, else 1, 2, ... by outlet
    std::int64_t cut = 0;             ///< reaches that leave the grid
    std::int64_t outside = 0;         ///< reaches that have no part in it
    std::int64_t nowhere = 0;         ///< lines with a vertex that is no number, which count as outside
};

/// The reaches of anyone's network. It need not be a set of trees: only ids and arcs downstream are asked for. One
/// downstream that the file does not hold makes an outlet; arcs of one id with the same one are parts of one reach.
/// Throws: BadInput: arcs of one id with several downstream, rivers that run in a circle, no arc in the grid.
FileReaches reaches_of_file(NetworkFile const& file, Grid const& grid);

} // namespace thalweg::pipeline
