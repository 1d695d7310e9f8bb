// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

namespace thalweg::solver {

/// Most cells of the torus that a fractional Brownian surface is embedded in: its eigenvalues take 4 GiB.
inline constexpr std::int64_t most_torus_cells = std::int64_t{1} << 31;

/// A fractional Brownian surface on a lattice, E (z(p) - z(q))^2 = |p - q|^(2H) with distances in cells. It is a
/// stationary field on a torus plus a random plane: within the lattice's diagonal d the field's covariance is
/// c0 - (r/d)^(2H) + c2 (r/d)^2, beyond it falls to 0 at reach d, and the plane takes c2 (r/d)^2 away.
struct FractionalSurface {
    std::int64_t width = 0;      ///< [cells] of the lattice
    std::int64_t height = 0;     ///< [cells]
    double hurst = 0.5;          ///< H
    double diagonal_cells = 1.0; ///< d
    double constant = 0.0;       ///< c0
    double square = 0.0;         ///< c2
    Circulant torus;             ///< at least width + reach d by height + reach d cells
};

/// \pre width and height [cells] > 0 of the lattice; hurst in (0, 1).
/// \param width [cells] number of columns
/// \param height [cells] number of rows
/// \param hurst (0, 1) Hurst exponent
/// \param run progress, log, stop token and number of threads
/// \return the surface; no eigenvalue of its torus is negative (up to rounding). Holds 2 bytes a cell of the torus,
/// whose reach is 1 for H up to 0.75 and 2 above.
/// \throws BadParameter H out of range, no cells, or more than most_torus_cells
/// \throws Cancelled
///
/// Source: \cite stein2002, Fast and exact simulation of fractional Brownian surfaces; \cite kroese2015, section 2.5;
/// the torus is shorter than theirs, since what lies beyond the lattice's own extent may wrap around.
FractionalSurface fractional_surface(std::int64_t width, std::int64_t height, double hurst, Run const& run = {});

/// \param width [cells] number of columns
/// \param height [cells] number of rows
/// \param hurst (0, 1) Hurst exponent
/// \throws Error what fractional_surface throws for its parameters, without the work
void check_fractional_surface(std::int64_t width, std::int64_t height, double hurst);

/// One surface, 0 in the north-western cell.
/// \pre seed and stage, which name the random numbers.
/// \param surface the prepared surface
/// \param seed random seed
/// \param stage number of the stage that draws
/// \param run progress, log, stop token and number of threads
/// \return jointly normal numbers on the lattice, exact at all pairs of cells; the same bits for any number of threads.
/// \throws Cancelled
Raster<double> sample(FractionalSurface const& surface, std::uint64_t seed, std::uint64_t stage, Run const& run = {});

/// Sums of variograms around weighted cells.
/// \post in each cell p the sum over all cells q of weights(q) |p - q|^(2H); the same bits for any number of threads.
/// \pre weights, a raster of the lattice's size.
/// \param surface the prepared surface
/// \param weights the weights
/// \param run progress, log, stop token and number of threads
/// \throws Cancelled
void superpose_variograms(FractionalSurface const& surface, Raster<double>& weights, Run const& run = {});

} // namespace thalweg::solver
