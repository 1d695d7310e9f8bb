// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Reads a mask: the cells of any raster file whose value is neither 0 nor no-data.
/// \pre a file whose cells are those of a grid.
/// \param path path of the file
/// \param grid the grid
/// \param run progress, log, stop token and number of threads
/// \return a mask on that grid.
/// \throws BadInput like read_dem; when the file's cells are not the grid's, or only one of both has a CRS, or their
/// CRS differ, naming both
/// \throws IoError
/// \throws Cancelled
Mask read_mask(std::string const& path, Grid const& grid, Run const& run = {});

} // namespace thalweg::io
