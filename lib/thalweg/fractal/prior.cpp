// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/internal/prior.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <thalweg/core/run/error.hpp>
#include <thalweg/solver/spectral/fft.hpp>

namespace thalweg::fractal {

namespace {

// So close to singular a matrix may be: below it two statistics, or two fixed heights, cannot be told apart.
constexpr double least_ridge = 1e-10;
constexpr double most_ridge = 1e-2;

} // namespace

solver::Cholesky factor_safely(std::vector<double> const& matrix, std::size_t size, Run const& run) {
    for (double ridge = least_ridge; ridge < most_ridge; ridge *= 100.0) {
        try {
            return solver::factor(matrix, size, ridge, run);
        } catch (NotConverged const&) {
        }
    }
    return solver::factor(matrix, size, most_ridge, run);
}

Prior::Prior(Grid const& grid, std::vector<FixedHeight> const& kept, solver::StableCovariance const& covariance,
             Run const& run)
    : grid_(grid), kept_(kept), torus_(solver::circulant(covariance, around(grid.width, covariance.lx_cells),
                                                         around(grid.height, covariance.ly_cells), run)),
      kept_covariance_(factor_kept(run)) {}

std::vector<double> Prior::at_kept(Raster<double> const& field) const {
    std::vector<double> values;
    for (FixedHeight const& one : kept_) {
        values.push_back(field[one.cell]);
    }
    return values;
}

std::vector<double> Prior::solve_kept(std::vector<double> values) const {
    return solver::solve(kept_covariance_, std::move(values));
}

Raster<double> Prior::spread(std::vector<double> const& weights, Run const& run) const {
    Raster<double> field(grid_);
    for (std::size_t p = 0; p < kept_.size(); ++p) {
        field[kept_[p].cell] = weights[p];
    }
    if (!kept_.empty()) {
        Raster<double> none(grid_);
        solver::multiply(torus_, field, none, run);
    }
    return field;
}

/// Where heights three correlation lengths apart hardly know of one another, a torus may be that much wider than
/// the grid.
std::int64_t Prior::around(std::int64_t cells, double length_cells) {
    auto const margin = static_cast<std::int64_t>(std::ceil(std::min(3.0 * length_cells, static_cast<double>(cells))));
    return solver::good_size(cells + margin);
}

solver::Cholesky Prior::factor_kept(Run const& run) const {
    std::size_t const n = kept_.size();
    std::vector<double> matrix(n * n);
    if (n > 0) {
        solver::Quarter const table = solver::covariances(torus_, run);
        auto const apart = [](std::int64_t a, std::int64_t b, std::int64_t length) {
            return std::min(std::abs(a - b), length - std::abs(a - b));
        };
        for (std::size_t p = 0; p < n; ++p) {
            for (std::size_t q = 0; q <= p; ++q) {
                Cell const a = kept_[p].cell;
                Cell const b = kept_[q].cell;
                matrix[p * n + q] = table[static_cast<std::size_t>(
                    apart(a.row, b.row, torus_.height) * (torus_.width / 2 + 1) + apart(a.col, b.col, torus_.width))];
            }
        }
    }
    return factor_safely(matrix, n, run);
}

} // namespace thalweg::fractal
