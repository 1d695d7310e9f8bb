// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::draw {

// The net of a wireframe on the ground.

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

// Which parts of a net over the land are seen.

using KnotId = std::int64_t; ///< place of a knot in a net, row by row

/// A fishnet over heights as a parallel projection shows it.
struct Net {
    std::int64_t columns = 0;
    std::int64_t rows = 0;
    Indexed<KnotId, Vec2> at; ///< knots on the sheet, row-major: x to the right, y up; NaN where there is none
    int away_col = 1;         ///< 1 or -1: columns grow away from the viewer or towards him
    int away_row = -1;        ///< likewise of rows

    Vec2 const& knot(std::int64_t col, std::int64_t row) const { return at[row * columns + col]; }
};

/// A line on the land: column and row of its vertices, fractions between knots.
using Thread = std::vector<Vec2>;

/// A stretch of a thread that is seen.
struct SeenThread {
    std::size_t thread = 0; ///< its number
    std::vector<Vec2> line; ///< on the sheet
};

struct Seen {
    std::vector<std::vector<Vec2>> net; ///< stretches of the net's lines
    std::vector<SeenThread> threads;
};

/// Takes the hidden parts away from a net and the threads on it, front to back against a floating horizon.
/// Takes: no mesh side parallel to the line of sight in plan; threads lie on the meshes, bilinear between knots.
/// Gives: a point of the net's lines is seen unless a line that crosses its column of the sheet nearer to the viewer
/// stands higher there. The land is a solid, seen from above: what lies below the horizon is hidden, so that one
/// horizon serves. A side of a mesh without one of its knots is left out, and what threads have there.
/// Threads may lie tolerance below the horizon. What is shorter than 0.001 on the sheet is left out.
/// Source: floating horizon, Wright 1973; the net of paper 001.
Seen hidden_lines(Net const& net, std::vector<Thread> const& threads, double tolerance);

} // namespace thalweg::draw
