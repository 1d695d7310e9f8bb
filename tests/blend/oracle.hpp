// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/blend/paste.hpp>

/// Pasting from its equations: a dense system over the cells that change, all distances by comparing all cells.
namespace oracle {

using namespace thalweg;

inline std::vector<Cell> around(Grid const& grid, Cell c) {
    std::vector<Cell> cells;
    for (Cell const n :
         {Cell{c.col - 1, c.row}, Cell{c.col + 1, c.row}, Cell{c.col, c.row - 1}, Cell{c.col, c.row + 1}}) {
        if (grid.contains(n)) {
            cells.push_back(n);
        }
    }
    return cells;
}

/// The x of A x = b, row by row; nothing when A is singular.
inline std::optional<std::vector<double>> solve(std::vector<std::vector<double>> a, std::vector<double> b) {
    std::size_t const n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t best = k;
        for (std::size_t r = k; r < n; ++r) {
            best = std::fabs(a[r][k]) > std::fabs(a[best][k]) ? r : best;
        }
        if (std::fabs(a[best][k]) < 1e-9) {
            return std::nullopt;
        }
        std::swap(a[k], a[best]);
        std::swap(b[k], b[best]);
        for (std::size_t r = k + 1; r < n; ++r) {
            double const share = a[r][k] / a[k][k];
            for (std::size_t c = k; c < n; ++c) {
                a[r][c] -= share * a[k][c];
            }
            b[r] -= share * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t c = k + 1; c < n; ++c) {
            b[k] -= a[k][c] * b[c];
        }
        b[k] /= a[k][k];
    }
    return b;
}

struct Problem {
    Raster<float> const& target;
    blend::Patch const& patch;
    blend::PasteParams const& params;

    bool changes(Cell c) const {
        bool const kept = params.keep.cells() > 0 && params.keep[c] != 0;
        return patch.mask[c] != 0 && !kept && (!std::isnan(patch.z[c]) || params.holes == blend::Holes::fill);
    }
    bool holds(Cell c) const { return !changes(c) && !std::isnan(target[c]); }

    /// To the nearest cell beside one that changes, which keeps its height.
    double depth(Cell c) const {
        Grid const& grid = target.grid();
        double nearest = 1e9;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            Cell const other = grid.at(i);
            bool beside = false;
            for (Cell const n : around(grid, other)) {
                beside = beside || changes(n);
            }
            if (holds(other) && beside) {
                nearest = std::min(nearest, std::hypot(static_cast<double>(other.col - c.col),
                                                       static_cast<double>(other.row - c.row)));
            }
        }
        return nearest;
    }

    double difference(Cell here, Cell there) const {
        double const own = static_cast<double>(target[there]) - target[here];
        double const patched = patch.z[there] - patch.z[here];
        if (std::isnan(patched)) {
            return std::isnan(own) ? 0.0 : own;
        }
        if (std::isnan(own)) {
            return patched;
        }
        double const taken =
            params.relief == blend::Relief::mixed && std::fabs(own) > std::fabs(patched) ? own : patched;
        if (params.feather_cells == 0.0) {
            return taken;
        }
        double const t = std::min(0.5 * (depth(here) + depth(there)) / params.feather_cells, 1.0);
        double const weight = 3.0 * t * t - 2.0 * t * t * t;
        return weight * taken + (1.0 - weight) * own;
    }
};

/// Heights of every cell, NaN as in the target; nothing where some part of the patch hangs on nothing.
inline std::optional<Raster<double>> paste(Problem const& problem) {
    Grid const& grid = problem.target.grid();
    std::vector<Cell> cells;
    std::vector<std::size_t> number(static_cast<std::size_t>(grid.cells()));
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (problem.changes(grid.at(i))) {
            number[static_cast<std::size_t>(i)] = cells.size();
            cells.push_back(grid.at(i));
        }
    }
    std::vector<std::vector<double>> a(cells.size(), std::vector<double>(cells.size(), 0.0));
    std::vector<double> b(cells.size(), 0.0);
    for (std::size_t k = 0; k < cells.size(); ++k) {
        for (Cell const n : around(grid, cells[k])) {
            if (!problem.changes(n) && !problem.holds(n)) {
                continue;
            }
            a[k][k] += 1.0;
            b[k] -= problem.difference(cells[k], n);
            if (problem.changes(n)) {
                a[k][number[static_cast<std::size_t>(grid.index(n))]] -= 1.0;
            } else {
                b[k] += problem.target[n];
            }
        }
    }
    auto const f = solve(std::move(a), std::move(b));
    if (!f) {
        return std::nullopt;
    }
    Raster<double> z(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        z[i] = problem.changes(grid.at(i)) ? (*f)[number[static_cast<std::size_t>(i)]] : problem.target[i];
    }
    return z;
}

} // namespace oracle
