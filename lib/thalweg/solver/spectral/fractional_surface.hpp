// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

namespace thalweg::solver {

/// Most cells of the torus in which a fractional Brownian surface is embedded; its eigenvalues then take 4 GiB.
inline constexpr std::int64_t most_torus_cells = std::int64_t{1} << 31;

/// A fractional Brownian surface on a lattice: E (z(p) - z(q))^2 = |p - q|^(2H), distances in cells. It is a stationary
/// field on a torus plus a random plane: within the lattice's diagonal d the field's covariance is c0 - (r/d)^(2H) + c2
/// (r/d)^2, beyond it falls to 0 at reach d; the plane removes c2 (r/d)^2.
struct FractionalSurface {
    std::int64_t width = 0;      ///< [cells] of the lattice
    std::int64_t height = 0;     ///< [cells]
    double hurst = 0.5;          ///< H
    double diagonal_cells = 1.0; ///< d
    double constant = 0.0;       ///< c0
    double square = 0.0;         ///< c2
    Circulant torus;             ///< at least width + reach d by height + reach d cells
};

/// Prepares a fractional Brownian surface. Memory: 2 bytes a cell of its torus, whose reach is 1 for H <= 0.75 and 2
/// above.
/// \param width [cells] > 0
/// \param height [cells] > 0
/// \param hurst (0, 1) Hurst exponent
/// \param run progress, log, stop token and number of threads
/// \return its torus has no negative eigenvalue (up to rounding)
/// \throws BadParameter when H is outside its range, for no cells, or for more than most_torus_cells
/// \throws Cancelled
///
/// Source: \cite stein2002, Fast and exact simulation of fractional Brownian surfaces; \cite kroese2015, section 2.5;
/// the torus is shorter than theirs, since what lies beyond the lattice's own extent may wrap around.
FractionalSurface fractional_surface(std::int64_t width, std::int64_t height, double hurst, Run const& run = {});

/// Checks the parameters of fractional_surface without preparing it.
/// \param width [cells] > 0
/// \param height [cells] > 0
/// \param hurst (0, 1) Hurst exponent
/// \throws BadParameter as fractional_surface
void check_fractional_surface(std::int64_t width, std::int64_t height, double hurst);

/// Draws a fractional Brownian surface, 0 in the north-western cell.
/// \param surface as fractional_surface returns it
/// \param seed random seed
/// \param stage number of the stage that draws, part of the random numbers' place
/// \param run progress, log, stop token and number of threads
/// \return the variogram is exact for all pairs of cells; the same bits for any number of threads
/// \throws Cancelled
Raster<double> sample(FractionalSurface const& surface, std::uint64_t seed, std::uint64_t stage, Run const& run = {});

/// Sums weighted variograms: in each cell p the sum over all cells q of weights(q) |p - q|^(2H). The same bits for any
/// number of threads.
/// \param surface as fractional_surface returns it
/// \param weights by cell of the lattice; replaced by the sums
/// \param run progress, log, stop token and number of threads
/// \throws Cancelled
void superpose_variograms(FractionalSurface const& surface, Raster<double>& weights, Run const& run = {});

} // namespace thalweg::solver
