// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::io {

/// A column of a table, asked row by row.
struct Column {
    enum class Kind { integer, wide_integer, real, text, date, time, datetime };
    using Value = std::variant<std::monostate, std::int64_t, double, std::string>; ///< the first is NULL

    std::string name; ///< in a shapefile at most 10 characters
    Kind kind = Kind::integer;
    int decimals = 0;                         ///< of a real in a shapefile, whose fields have 24 characters
    std::function<Value(std::size_t row)> at; ///< of the kind's type; texts for dates and times
    bool is_users = false;                    ///< may be NULL, and numbers of any size
    bool may_be_null = false;
};

/// A layer of a vector file: its features are the rows [0, rows), numbered from 1.
struct Table {
    /// plan_line, plan_point: without heights; partly_line: NaN at vertices without one
    enum class Shape { none, point, line, plan_line, polygon, multi_polygon, partly_line, plan_point };

    std::string name;
    Shape shape = Shape::none;
    std::size_t rows = 0;
    std::vector<Column> columns;
    std::function<std::vector<Vec3>(std::size_t row)>
        shape_at; ///< one position for a point, or none; a closed ring for a polygon
    std::function<std::vector<Polygon>(std::size_t row)> parts_at =
        {};                 ///< of a multi_polygon, in plan: outer ring first; asked instead of shape_at
    std::string style = {}; ///< by which QGIS draws it (QgisStyle), a default of the GeoPackage; "": none
};

/// \internal
/// Writes tables as the layers of a new GeoPackage, those without shape as attribute tables.
/// \post the same bytes for the same tables.
/// \param tables the values of the tables
/// \param crs "EPSG:n" or WKT; "": none
/// \param path path of the file
/// \throws BadInput naming table, row and column when a number is not finite or does not fit its column
/// \throws IoError also when the file exists
void write_tables(std::vector<Table> const& tables, std::string const& crs, std::string const& path,
                  Run const& run = {});

} // namespace thalweg::io
