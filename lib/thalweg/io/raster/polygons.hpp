// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/tables/table.hpp>

namespace thalweg::io {

/// \param source the file
/// \return whether a file is one that OGR reads and has a layer of polygons.
/// \throws BadInput when there is none or GDAL cannot read it
bool holds_polygons(Source const& source);

/// \param source the file
/// \return the CRS in metres in which a file's polygons are read where none is set: the file's own when it is projected
/// in metres, else the UTM zone of the middle of its box.
/// \throws BadInput as read_polygons, and for a file without CRS
std::string crs_for_polygons(Source const& source);

/// The CRS of a file's polygons.
struct PolygonsCrs {
    std::string crs;        ///< "EPSG:n" or WKT; "": none
    bool in_metres = false; ///< projected, in metres
};

/// \param source the file
/// \return the CRS of the file's layer of polygons
/// \throws BadInput as read_polygons
PolygonsCrs crs_of_polygons(Source const& source);

/// Reads the polygons of any OGR source, multi-part ones part by part, curves as OGR linearises them.
/// \pre the CRS of the result as in Grid, "" for none.
/// \param source the file
/// \param crs "EPSG:n" or WKT; "": none
/// \return vertices reprojected and rounded to 1e-6 of a unit.
/// \throws BadInput naming file, layer and feature: missing file, no or several layers of polygons, no features,
/// something that is not a polygon, coordinates that are not finite or cannot be reprojected, a CRS on one side only
/// (naming both)
/// \throws IoError when the file cannot be read to its end
Polygons read_polygons(Source const& source, std::string const& crs, Run const& run = {});

/// \param source the file
/// \param crs "EPSG:n" or WKT; "": none
/// \param field name of a numeric field
/// \return the same, each with the value of a numeric field.
/// \throws Error also BadInput when the layer has no such field, or a feature no finite value in it
Polygons read_polygons(Source const& source, std::string const& crs, std::string const& field, Run const& run = {});

/// \param source the file
/// \param crs "EPSG:n" or WKT; "": none
/// \param field name of a numeric field, in letters of any case
/// \return the same, but NaN where the layer has no such field or a feature no value in it.
/// \throws Error also BadInput where a value is not a finite number
Polygons read_polygons_valued(Source const& source, std::string const& crs, std::string const& field,
                              Run const& run = {});

/// [m] Between the parts of a lake on two sheets of a map.
inline constexpr double gap_between_sheets_m = 1.0;

/// Unites polygons that overlap or touch, and mends those that cross themselves.
/// \param polygons any; rings of fewer than three vertices are left out
/// \param gap_m [m] >= 0: those of the same group of boxes that are nearer, or touch in a point, become one too; their
/// outlines may then move by less than that
/// \return valid polygons, of which no two share more than a point; each with the lowest feature of its own
///
/// Source: GEOS, by GDAL.
std::vector<Polygon> united(std::vector<Polygon> polygons, double gap_m = 0.0);

/// The catchment of an arc as a row.
struct CatchmentRow {
    std::int64_t arc_id = 0;
    std::int64_t ds_arc = 0;   ///< arc_id of the arc downstream; 0: none
    std::int64_t basin_id = 0; ///< the same for all arcs that share an outlet
    std::int64_t cells = 0;
    std::int64_t upstream_cells = 0; ///< of it and all catchments upstream
};

/// Catchments by cell, with their attributes.
struct CatchmentTables {
    Raster<std::int32_t> const& number; ///< by cell: row of its catchment; below 0: none
    std::vector<CatchmentRow> const& rows;
    std::vector<Column> columns = {};       ///< further ones of catchments, asked by number
    std::vector<Column> basin_columns = {}; ///< further ones of basins, asked by place in the order of basin_id
};

/// Numbers the basins that have cells, as the layer basins does.
/// \param tables catchments
/// \return by cell: place in the order of basin_id; -1: none
Raster<std::int32_t> basins_by_cell(CatchmentTables const& tables);

/// The numbers of features in a file.
struct CatchmentCount {
    std::int64_t catchments = 0; ///< one per arc with cells
    std::int64_t parts = 0;      ///< their polygons: cells that touch only at corners are several
    std::int64_t basins = 0;
};

/// Writes outlines along the borders of cells (MultiPolygon) as a new GeoPackage, in the grid's CRS. Layer catchments:
/// arc_id, ds_arc, basin_id, cells (integer), area and ds_area [m2] (real): of the catchment, and of everything that
/// drains to the arc's lower end, as in the layer arcs; an arc without cells has no catchment. Layer basins: basin_id,
/// arcs, cells (integer), area. The polygons tile the cells with a number, are valid and have no gaps or overlaps; the
/// same bytes for the same tables.
/// \param tables catchments
/// \param path of the file
/// \return number of features
/// \throws BadInput when a row has another number of cells than it states
/// \throws IoError also when the file exists
CatchmentCount write_catchments(CatchmentTables const& tables, std::string const& path, Run const& run = {});

} // namespace thalweg::io
