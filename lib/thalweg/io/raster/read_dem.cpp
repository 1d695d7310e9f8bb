// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/raster_files.hpp>

#include <algorithm>
#include <cmath>
#include <unistd.h>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/raster/internal/opened_heights.hpp>
#include <thalweg/io/raster/internal/read_dem.hpp>

namespace thalweg::io {

void require_memory(Grid const& grid, About const& about) {
    double const needed = static_cast<double>(grid.cells()) * sizeof(float);
    double const there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    refuse_if<BadInput>(needed > there, about.where, "{} of {} x {} cells is larger than memory", about.name,
                        grid.width, grid.height);
}

namespace {

Grid grid_of(OpenedHeights const& opened, About const& about) {
    auto const [west, dx, skew_x, north, skew_y, dy] = opened.frame();
    refuse_if<BadInput>(skew_x != 0.0 || skew_y != 0.0, about.where,
                        "{} is rotated: warp it to a north-up grid (gdalwarp -novshift)", about.name);
    refuse_if<BadInput>(!opened.is_grid(), about.where,
                        "{} has cells of {} x {}, not squares: warp it (gdalwarp -novshift -tr {} {})", about.name, dx,
                        -dy, dx, dx);
    Grid grid;
    grid.width = opened.width();
    grid.height = opened.height();
    grid.west = west;
    grid.north = north;
    grid.cell_m = dx;
    grid.crs = opened.crs();
    return grid;
}

DemFile read(Source const& source, HeightsIn wanted, ReadDemParams const& params, Run const& run) {
    About const about{"io.read_dem", source.path};
    OpenedHeights opened(source, params, wanted, about);
    Grid const grid = grid_of(opened, about);
    require_memory(grid, about);
    DemFile file{Raster<float>(grid), {}};
    opened.read([&](int row, std::span<float const> heights) { std::ranges::copy(heights, file.dem.row(row).begin()); },
                run);
    file.findings = opened.take_findings();
    return file;
}

} // namespace

DemFile read_dem_file(Source const& source, ReadDemParams const& params, Run const& run) {
    return read(source, HeightsIn::metres, params, run);
}

Raster<float> read_dem(Source const& source, ReadDemParams const& params, Run const& run) {
    return read_dem_file(source, params, run).dem;
}

Raster<float> read_dem(Source const& source, Run const& run) {
    return read_dem_file(source, {}, run).dem;
}

Raster<float> read_stored_dem(Source const& source, ReadDemParams const& params, Run const& run) {
    return read(source, HeightsIn::stored, params, run).dem;
}

Mask read_mask(Source const& source, Grid const& grid, Run const& run) {
    Raster<float> const values = read_dem(source, {.values = CellValues::codes}, run);
    About const about{"io.read_mask", source.path};
    Grid const& own = values.grid();
    refuse_if<BadInput>(!same_cells(own, grid), about.where,
                        "{} has {} x {} cells of {} from ({}, {}), the grid {} x {} of {} from ({}, {}): a mask has "
                        "the grid's cells (gdalwarp -te ... -ts ...)",
                        about.name, own.width, own.height, own.cell_m, own.west, own.north, grid.width, grid.height,
                        grid.cell_m, grid.west, grid.north);
    refuse_if<BadInput>(!is_same_crs(own.crs, grid.crs, about, "the grid"), about.where,
                        "{} is in {:.60}, the grid in {:.60}: warp it (gdalwarp -novshift -t_srs)", about.name, own.crs,
                        grid.crs);
    Mask mask(grid);
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        mask[i] = !std::isnan(values[i]) && values[i] != 0.0F ? 1 : 0;
    }
    return mask;
}

} // namespace thalweg::io
