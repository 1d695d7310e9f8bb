// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/write_catchments.hpp>

#include <map>

#include <fmt/format.h>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/network/table.hpp>
#include <thalweg/io/raster/internal/polygonise.hpp>

namespace thalweg::io {

namespace {

using Kind = Column::Kind;

/// The catchments that share an outlet.
struct Basin {
    std::int64_t id = 0;
    std::int64_t arcs = 0;
    std::int64_t cells = 0;
};

void require_counted(CatchmentTables const& tables, std::string const& what) {
    Indexed<std::int32_t, std::int64_t> counted(tables.rows.size(), 0);
    for (std::int32_t const number : tables.number.values()) {
        if (number >= 0 && number < counted.count()) {
            ++counted[number];
        }
    }
    for (std::size_t i = 0; i < counted.size(); ++i) {
        if (counted[i] != tables.rows[i].cells) {
            throw BadInput(fmt::format("{}: the catchment of arc {} has {} cells, its row says {}", what,
                                       tables.rows[i].arc_id, counted[i], tables.rows[i].cells));
        }
    }
}

/// Basins by their id, and by row which it is.
std::vector<Basin> basins_of(std::vector<CatchmentRow> const& rows, Indexed<std::int32_t, std::int32_t>& basin_of_row) {
    std::map<std::int64_t, Basin> by_id;
    for (CatchmentRow const& row : rows) {
        if (row.cells > 0) {
            Basin& basin = by_id[row.basin_id];
            basin.id = row.basin_id;
            ++basin.arcs;
            basin.cells += row.cells;
        }
    }
    std::vector<Basin> basins;
    std::map<std::int64_t, std::int32_t> place;
    for (auto const& [id, basin] : by_id) {
        place[id] = static_cast<std::int32_t>(basins.size());
        basins.push_back(basin);
    }
    for (CatchmentRow const& row : rows) {
        basin_of_row.push_back(row.cells > 0 ? place[row.basin_id] : -1);
    }
    return basins;
}

} // namespace

CatchmentCount write_catchments(CatchmentTables const& tables, std::string const& path, Run const& run) {
    Grid const& grid = tables.number.grid();
    double const cell_m2 = grid.cell_m * grid.cell_m;
    require_counted(tables, "io.write_catchments: " + path);

    auto const outlines = polygonise(tables.number, static_cast<std::int64_t>(tables.rows.size()), run);
    std::vector<std::size_t> drawn; // rows with cells
    CatchmentCount count;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        if (!outlines[i].empty()) {
            drawn.push_back(i);
            count.parts += static_cast<std::int64_t>(outlines[i].size());
        }
    }
    Indexed<std::int32_t, std::int32_t> basin_of_row;
    auto const basins = basins_of(tables.rows, basin_of_row);
    Raster<std::int32_t> basin_number(grid, -1);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (tables.number[i] >= 0) {
            basin_number[i] = basin_of_row[tables.number[i]];
        }
    }
    auto const shores = polygonise(basin_number, static_cast<std::int64_t>(basins.size()), run);
    count.catchments = static_cast<std::int64_t>(drawn.size());
    count.basins = static_cast<std::int64_t>(basins.size());

    auto const row_at = [&](std::size_t row) -> CatchmentRow const& { return tables.rows[drawn[row]]; };
    auto const area = [cell_m2](std::int64_t cells) { return static_cast<double>(cells) * cell_m2; };
    Table catchments{"catchments", Table::Shape::multi_polygon, drawn.size(), {}, {}};
    catchments.columns = {
        {"arc_id", Kind::wide_integer, 0, [=](std::size_t row) { return row_at(row).arc_id; }},
        {"ds_arc", Kind::wide_integer, 0, [=](std::size_t row) { return row_at(row).ds_arc; }},
        {"basin_id", Kind::wide_integer, 0, [=](std::size_t row) { return row_at(row).basin_id; }},
        {"cells", Kind::wide_integer, 0, [=](std::size_t row) { return row_at(row).cells; }},
        {"area", Kind::real, 0, [=](std::size_t row) { return area(row_at(row).cells); }},
        {"ds_area", Kind::real, 0, [=](std::size_t row) { return area(row_at(row).upstream_cells); }},
    };
    catchments.parts_at = [&](std::size_t row) { return outlines[drawn[row]]; };

    auto const basin_at = [&](std::size_t row) -> Basin const& { return basins[row]; };
    Table whole{"basins", Table::Shape::multi_polygon, basins.size(), {}, {}};
    whole.columns = {
        {"basin_id", Kind::wide_integer, 0, [=](std::size_t row) { return basin_at(row).id; }},
        {"arcs", Kind::wide_integer, 0, [=](std::size_t row) { return basin_at(row).arcs; }},
        {"cells", Kind::wide_integer, 0, [=](std::size_t row) { return basin_at(row).cells; }},
        {"area", Kind::real, 0, [=](std::size_t row) { return area(basin_at(row).cells); }},
    };
    whole.parts_at = [&](std::size_t row) { return shores[row]; };
    write_tables({std::move(catchments), std::move(whole)}, grid.crs, path, run);
    return count;
}

} // namespace thalweg::io
