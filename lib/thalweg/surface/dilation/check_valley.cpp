// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/dilation/internal/check_valley.hpp>

#include <thalweg/core/run/error.hpp>

#include <fmt/format.h>

#include <cmath>

namespace thalweg::surface {

void check_frame(Grid const& grid) {
    if (grid.cells() <= 0) {
        throw BadInput("surface.dilate: the valley's grid has no cells; make it at least 1 x 1");
    }
    if (!(grid.cell_m > 0.0 && std::isfinite(grid.cell_m))) {
        throw BadInput(fmt::format("surface.dilate: the valley's cell size is {} m; give one above 0", grid.cell_m));
    }
}

void check_heights(Raster<float> const& valley) {
    Grid const& grid = valley.grid();
    bool wet = false;
    for (std::int64_t i = 0; i < valley.cells(); ++i) {
        if (std::isinf(valley[i])) {
            Cell const cell = grid.at(i);
            throw BadInput(fmt::format("surface.dilate: infinite height in the valley at column {}, row {}; "
                                       "every river needs finite heights",
                                       cell.col, cell.row));
        }
        wet = wet || !std::isnan(valley[i]);
    }
    if (!wet) {
        throw BadInput(
            fmt::format("surface.dilate: no cell of the valley has a height on the grid of {} x {} cells (inside "
                        "the mask, where there is one); let a river run there",
                        grid.width, grid.height));
    }
}

void check_mask(Grid const& valley, Grid const& mask) {
    if (valley != mask) {
        throw BadInput(fmt::format("surface.dilate: the mask ({} x {} cells of {} m) has another frame than the valley "
                                   "({} x {} cells of {} m); make both on one grid",
                                   mask.width, mask.height, mask.cell_m, valley.width, valley.height, valley.cell_m));
    }
}

} // namespace thalweg::surface
