// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/file_values.hpp>

#include <limits>

namespace thalweg::pipeline {

namespace {

template <class T> Raster<double> in_m2(Raster<T> const& cells) {
    Grid const& grid = cells.grid();
    double const cell_m2 = grid.cell_m * grid.cell_m;
    Raster<double> m2(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        m2[i] = cells[i] > 0 ? static_cast<double>(cells[i]) * cell_m2 : std::numeric_limits<double>::quiet_NaN();
    }
    return m2;
}

} // namespace

std::vector<io::CatchmentRow> catchment_rows(std::vector<flow::Reach> const& reaches,
                                             std::vector<std::int64_t> const& basins,
                                             flow::Catchments const& catchments) {
    std::vector<io::CatchmentRow> rows;
    rows.reserve(reaches.size());
    for (std::size_t a = 0; a < reaches.size(); ++a) {
        std::int64_t const ds = reaches[a].ds;
        rows.push_back({reaches[a].id, ds < 0 ? 0 : reaches[static_cast<std::size_t>(ds)].id, basins[a],
                        catchments.cells[a], catchments.upstream[a]});
    }
    return rows;
}

Raster<double> areas_m2(flow::FlowField const& drainage) {
    return in_m2(drainage.area_cells);
}

Raster<double> areas_m2(Raster<double> const& area_cells) {
    return in_m2(area_cells);
}

} // namespace thalweg::pipeline
