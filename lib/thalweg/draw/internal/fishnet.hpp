// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/raster.hpp>

/// The net of a wireframe on the ground. Private to this module.
namespace thalweg::draw {

/// Knots with heights. Knot (0, 0) is the north-western one.
struct Fishnet {
    std::int64_t columns = 0;
    std::int64_t rows = 0;
    Indexed<ColumnIndex, double> col_at; ///< column of the DEM of every column of knots; cell centres are whole numbers
    Indexed<RowIndex, double> row_at;    ///< likewise of rows
    Indexed<std::int64_t, double> height_m; ///< by knot, row-major; NaN where most of the land around it has no height
    double low_m = 0.0;                     ///< of the knots; low > high where none has a height
    double high_m = 0.0;
};

/// A net of at most most_lines lines each way over the part of a DEM that holds heights, its meshes as square as whole
/// numbers allow.
/// Takes: a DEM of one cell or more; most_lines >= 2. Gives: a knot in every cell where these are few enough, else
/// evenly spread knots with the mean height around them. A single row or column of cells gets two lines, on its edges.
Fishnet fishnet(Raster<float> const& dem, std::int64_t most_lines);

} // namespace thalweg::draw
