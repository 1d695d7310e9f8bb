// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Brings a DEM into the coordinates and the cell size of a grid.
/// \pre what names the DEM in messages: "io.warp_to_grid: source.tif".
/// \param dem [m] heights by cell; NaN: no data
/// \param grid the grid
/// \param what what it is, for messages
/// \param run progress, log, stop token and number of threads
/// \return the DEM as it stands where CRS and cell size are the grid's; else warped (bilinear, means where cells become
/// larger) to squares of the grid's size on the lattice that the grid's own are part of; NaN where it has no data.
/// \throws BadInput when only one of both has a CRS, naming both; when it cannot be warped to the grid's or becomes
/// larger than memory
/// \throws IoError
/// \throws Cancelled
Raster<float> warp_to_grid(Raster<float> const& dem, Grid const& grid, std::string const& what, Run const& run = {});

} // namespace thalweg::io
