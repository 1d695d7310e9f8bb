// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/solver/linear/cholesky.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

namespace thalweg::fractal {

/// Factor of a symmetric matrix with the least ridge that makes it positive definite. Throws: NotConverged.
solver::Cholesky factor_safely(std::vector<double> const& matrix, std::size_t size, Run const& run);

/// The prior's covariance, and that part of it which the fixed heights leave.
class Prior {
public:
    Prior(Grid const& grid, std::vector<FixedHeight> const& kept, solver::StableCovariance const& covariance,
          Run const& run);

    solver::Circulant const& torus() const { return torus_; }
    std::vector<double> at_kept(Raster<double> const& field) const;
    std::vector<double> solve_kept(std::vector<double> values) const;

    /// The covariance of every cell with weighted fixed cells (kriging).
    Raster<double> spread(std::vector<double> const& weights, Run const& run) const;

private:
    static std::int64_t around(std::int64_t cells, double length_cells);
    solver::Cholesky factor_kept(Run const& run) const;

    Grid grid_;
    std::vector<FixedHeight> const& kept_;
    solver::Circulant torus_;
    solver::Cholesky kept_covariance_;
};

} // namespace thalweg::fractal
