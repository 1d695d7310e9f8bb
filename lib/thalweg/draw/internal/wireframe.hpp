// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::draw {

// The net of a wireframe over the terrain.

/// Knots with heights. Knot (0, 0) is the north-western one.
struct Fishnet {
    std::int64_t columns = 0;
    std::int64_t rows = 0;
    std::vector<double> col_at;   ///< column of the DEM by column of knots; cell centres are whole numbers
    std::vector<double> row_at;   ///< the same for rows
    std::vector<double> height_m; ///< by knot, row-major; NaN: most of the terrain around it has no height
    double low_m = 0.0;           ///< of the knots; low > high: none has a height
    double high_m = 0.0;
};

/// Makes a net of at most most_lines lines in each direction over the part of a DEM with heights, with meshes as square
/// as whole numbers allow.
/// \param dem at least one cell
/// \param most_lines >= 2
/// \return a knot in every cell if these are few enough, otherwise evenly spaced knots with the mean height around
/// them. A single row or column of cells has two lines, on its edges.
Fishnet fishnet(Raster<float> const& dem, std::int64_t most_lines);

// Hidden-line removal for a net over terrain.

using KnotId = std::int64_t; ///< index of a knot in a net, row by row

/// A fishnet over heights in parallel projection.
struct Net {
    std::int64_t columns = 0;
    std::int64_t rows = 0;
    std::vector<Vec2> at; ///< knots on the sheet, row-major: x to the right, y up; NaN: none
    int away_col = 1;     ///< 1 or -1: columns grow away from or towards the viewer
    int away_row = -1;    ///< the same for rows

    Vec2 const& knot(std::int64_t col, std::int64_t row) const { return at[row * columns + col]; }
};

/// A line on the terrain: column and row of its vertices, fractional between knots.
using Thread = std::vector<Vec2>;

/// A visible part of a thread.
struct SeenThread {
    std::size_t thread = 0; ///< index of the thread
    std::vector<Vec2> line; ///< on the sheet
};

struct Seen {
    std::vector<std::vector<Vec2>> net; ///< visible parts of the net's lines
    std::vector<SeenThread> threads;
};

/// Removes the hidden parts of a net and of the threads on it, front to back against a floating horizon. A point of the
/// net's lines is visible unless a line closer to the viewer is higher in its column of the sheet. The terrain is a
/// solid seen from above: everything below the horizon is hidden, so that one horizon suffices. Sides of meshes with a
/// missing knot, and threads there, are left out; so are parts shorter than 0.001 on the sheet.
/// \param net no mesh side is parallel to the line of sight in plan
/// \param threads lie on the meshes, bilinear between knots
/// \param tolerance allowed depth of threads below the horizon
/// \return the visible parts
///
/// Source: floating horizon, Wright 1973; the net of \cite zhang.
Seen hidden_lines(Net const& net, std::vector<Thread> const& threads, double tolerance);

} // namespace thalweg::draw
