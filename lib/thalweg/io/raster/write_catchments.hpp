// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// The catchment of an arc, as its row says.
struct CatchmentRow {
    std::int64_t arc_id = 0;
    std::int64_t ds_arc = 0;   ///< arc_id of the arc downstream; 0 for none
    std::int64_t basin_id = 0; ///< the same for all arcs that share an outlet
    std::int64_t cells = 0;
    std::int64_t upstream_cells = 0; ///< of it and of all catchments upstream
};

/// Catchments by cell, and what is known of each.
struct CatchmentTables {
    Raster<std::int32_t> const& number; ///< by cell, the row of its catchment; below 0 for none
    std::vector<CatchmentRow> const& rows;
};

/// How many of each there are in a file.
struct CatchmentCount {
    std::int64_t catchments = 0; ///< one an arc that has a cell
    std::int64_t parts = 0;      ///< polygons they consist of: cells that touch in corners only are several
    std::int64_t basins = 0;
};

/// Writes a new GeoPackage of outlines along the edges of cells (MultiPolygon), in the grid's CRS. Layer catchments:
/// arc_id, ds_arc, basin_id, cells (integer), area and ds_area [m2] (real): of the catchment, and of all that drains to
/// the arc's lower end, as in the layer arcs; an arc without cells has no catchment. Layer basins: basin_id, arcs,
/// cells (integer), area.
/// \param tables the values of the tables
/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \return polygons that tile the cells with a number, valid and without gaps or overlaps; the same bytes for the same
/// tables.
/// \throws BadInput when the cells of a row are not as many as it says
/// \throws IoError also when the file exists
/// \throws Cancelled
CatchmentCount write_catchments(CatchmentTables const& tables, std::string const& path, Run const& run = {});

} // namespace thalweg::io
