// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/cells.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg {

std::vector<Cell> cells_of_vertices(std::vector<Vec2> const& line, Grid const& grid, std::string const& what) {
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < line.size(); ++i) {
        // Compare as floating point first: a position far outside has no 64-bit cell.
        bool const within =
            line[i].x >= grid.west && line[i].x <= grid.east() && line[i].y <= grid.north && line[i].y >= grid.south();
        if (!within || !grid.contains(grid.cell_of(line[i]))) {
            throw BadInput("core.cells_along",
                           fmt::format("vertex {} of {} at ({:.3f}, {:.3f}) lies outside the grid (x {:.3f} to {:.3f}, "
                                       "y {:.3f} to {:.3f}); enlarge the grid or clip the rivers",
                                       i, what, line[i].x, line[i].y, grid.west, grid.east(), grid.south(),
                                       grid.north));
        }
        cells.push_back(grid.cell_of(line[i]));
    }
    return cells;
}

std::vector<Cell> cells_along(std::vector<Vec2> const& line, Grid const& grid, std::string const& what) {
    std::vector<Cell> const at = cells_of_vertices(line, grid, what);
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < at.size(); ++i) {
        walk_cells(at[i == 0 ? 0 : i - 1], at[i], [&](Cell c, std::int64_t, std::int64_t) {
            if (cells.empty() || !(cells.back() == c)) {
                cells.push_back(c);
            }
        });
    }
    return cells;
}

namespace {

/// The marked cell of a column nearest to the current row, and the columns for which it is the nearest.
struct Site {
    std::int64_t col = 0;
    std::int64_t row = 0;
    std::int64_t rise = 0;  ///< squared distance to the current row
    std::int64_t first = 0; ///< first column of the row in which it beats the sites before it
};

bool comes_first(Site const& a, Site const& b) {
    return a.row < b.row || (a.row == b.row && a.col < b.col);
}

bool beats(Site const& a, Site const& b, std::int64_t col) {
    std::int64_t const to_a = (col - a.col) * (col - a.col) + a.rise;
    std::int64_t const to_b = (col - b.col) * (col - b.col) + b.rise;
    return to_a < to_b || (to_a == to_b && comes_first(a, b));
}

/// First column in which `right` beats `left`; called only where that column is above 0.
std::int64_t crossing(Site const& left, Site const& right) {
    std::int64_t const num = right.col * right.col + right.rise - left.col * left.col - left.rise;
    std::int64_t const den = 2 * (right.col - left.col);
    bool const wins_tie = num % den == 0 && comes_first(right, left);
    return num / den + (wins_tie ? 0 : 1);
}

/// Rows of the nearest marked cells within the columns [first, last), the upper of two; -1 in a column without any.
void search_columns(Mask const& marked, Raster<std::int64_t>& nearest, std::int64_t first, std::int64_t last) {
    std::int64_t const width = marked.width();
    std::int64_t const height = marked.height();
    for (std::int64_t row = 0; row < height; ++row) {
        for (std::int64_t i = row * width + first; i < row * width + last; ++i) {
            nearest[i] = marked[i] != 0 ? row : (row > 0 ? nearest[i - width] : -1);
        }
    }
    for (std::int64_t row = height - 2; row >= 0; --row) {
        for (std::int64_t i = row * width + first; i < row * width + last; ++i) {
            std::int64_t const below = nearest[i + width];
            if (below > row && (nearest[i] < 0 || below - row < row - nearest[i])) {
                nearest[i] = below;
            }
        }
    }
}

/// Turns the nearest rows of one row of cells into the nearest cells: lower envelope of one parabola a column.
void search_row(Raster<std::int64_t>& nearest, std::int64_t row, std::vector<Site>& envelope) {
    std::int64_t const width = nearest.width();
    envelope.clear();
    for (std::int64_t col = 0; col < width; ++col) {
        std::int64_t const at = nearest[row * width + col];
        if (at < 0) {
            continue;
        }
        Site site{col, at, (at - row) * (at - row), 0};
        while (!envelope.empty() && beats(site, envelope.back(), envelope.back().first)) {
            envelope.pop_back();
        }
        if (!envelope.empty()) {
            site.first = crossing(envelope.back(), site);
        }
        if (site.first < width) {
            envelope.push_back(site);
        }
    }
    std::size_t k = 0;
    for (std::int64_t col = 0; col < width; ++col) {
        while (k + 1 < envelope.size() && envelope[k + 1].first <= col) {
            ++k;
        }
        nearest[row * width + col] = envelope[k].row * width + envelope[k].col;
    }
}

} // namespace

Raster<std::int64_t> nearest_cells(Mask const& marked, Run const& run) {
    bool const any = std::any_of(marked.values().begin(), marked.values().end(), [](std::uint8_t m) { return m != 0; });
    if (!any) {
        throw BadInput("core.nearest_cells", "no cell is marked");
    }
    Raster<std::int64_t> nearest(marked.grid());
    parallel_ranges(run, marked.width(), 64, [&](std::int64_t first, std::int64_t last) {
        run.check();
        search_columns(marked, nearest, first, last);
    });
    parallel_ranges(run, marked.height(), 64, [&](std::int64_t first, std::int64_t last) {
        std::vector<Site> envelope;
        for (std::int64_t row = first; row < last; ++row) {
            run.check();
            search_row(nearest, row, envelope);
        }
    });
    return nearest;
}

} // namespace thalweg
