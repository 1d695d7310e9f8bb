// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/read_mask.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/raster/read_dem.hpp>

namespace thalweg::io {

Mask read_mask(std::string const& path, Grid const& grid, Run const& run) {
    Raster<float> const values = read_dem(path, {.values = CellValues::numbers}, run);
    std::string const what = "io.read_mask: " + path;
    Grid const& own = values.grid();
    if (!same_cells(own, grid)) {
        throw BadInput(fmt::format("{} has {} x {} cells of {} from ({}, {}), the grid {} x {} of {} from ({}, {}): a "
                                   "mask has the grid's cells (gdalwarp -te ... -ts ...)",
                                   what, own.width, own.height, own.cell_m, own.west, own.north, grid.width,
                                   grid.height, grid.cell_m, grid.west, grid.north));
    }
    if (!same_crs(own.crs, grid.crs, what, "the grid")) {
        throw BadInput(
            fmt::format("{} is in {:.60}, the grid in {:.60}: warp it (gdalwarp -t_srs)", what, own.crs, grid.crs));
    }
    Mask mask(grid);
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        mask[i] = !std::isnan(values[i]) && values[i] != 0.0F ? 1 : 0;
    }
    return mask;
}

} // namespace thalweg::io
