// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <cstdint>
#include <functional>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: The covariance matrix of a stationary field on a torus is circulant, so that a Fourier
// transform diagonalises it: its eigenvalues are the transform of the covariance. A field with
// exactly this covariance is white noise times the roots of the eigenvalues, transformed back. A
// grid is a part of a large enough torus; where the covariance does not fit, some eigenvalues come
// out negative, are set to 0, and their share is reported. The same transforms multiply a field by
// the covariance matrix. A fractional Brownian surface is not stationary, but is a stationary field
// with compact support plus a random plane, which Stein chose so that no eigenvalue is negative.
// Source: Dietrich and Newsam 1997; Wood and Chan 1994; Stein 2002, Kroese and Botev 2015
// (fractional surfaces; our torus is shorter).
// Cost: O(t log t) for t cells of the torus, 2 bytes each for eigenvalues (a quarter is kept);
// drawing takes 16 bytes for each row of the grid times half the torus' width. Rows and bundles of
// columns run on all cores.
// Not for: fields that vary from place to place, or that pass through points (fractal/ conditions
// by kriging). Smooth fields with long correlation need a torus several times as wide.
// Example:
//     StableCovariance const covariance{.lx_cells = 20.0, .ly_cells = 40.0, .dimension = 2.4};
//     std::int64_t const side = good_size(4 * std::max(grid.width, grid.height));
//     Circulant const torus = circulant(covariance, side, side);
//     Raster<double> const field = sample(torus, grid, 7, 1); // of mean 0 and deviation 1
// More: docs/statistics.md.

namespace thalweg::solver {

/// The stable covariance exp(-((dx/lx)^2 + (dy/ly)^2)^(3 - dimension)): 1/e at the distances lx along rows and ly along
/// columns. A share of the variance may belong to fine forms, with fine_cells for both lengths. Source: \cite zhang,
/// section 2; the exponent of Gneiting and Schlather 2004.
struct StableCovariance {
    double lx_cells = 20.0;   ///< [cells] > 0
    double ly_cells = 20.0;   ///< [cells] > 0
    double dimension = 2.4;   ///< fractal dimension in (2, 3)
    double fine_share = 0.0;  ///< [0, 1)
    double fine_cells = 12.0; ///< [cells] > 0

    double operator()(double dx_cells, double dy_cells) const;
};

/// Checks a covariance.
/// \param covariance any values
/// \param stage name of the stage, for messages
/// \throws BadParameter when a length or the dimension is outside its range
void check(StableCovariance const& covariance, char const* stage);

/// Values at the distances (0..width/2, 0..height/2) on a torus, in row order; the rest of the torus mirrors them.
using Quarter = std::vector<double, LargePages<double>>;

/// The eigenvalues, >= 0, of a covariance on a torus.
struct Circulant {
    std::int64_t width = 0;  ///< [cells] even
    std::int64_t height = 0; ///< [cells] even
    Quarter eigenvalues;
    double negative_share = 0.0; ///< sum of the negative eigenvalues, set to 0, relative to the sum of all
};

/// Embeds a covariance in a torus, where distances are the shorter way round. Memory: 2 bytes a cell of the torus.
/// \param covariance by distance [cells]
/// \param width [cells] even, at least 2
/// \param height [cells] even, at least 2
/// \return its eigenvalues; negative ones are set to 0
///
/// Source: \cite dietrich1997; \cite wood1994.
Circulant circulant(StableCovariance const& covariance, std::int64_t width, std::int64_t height, Run const& run = {});

/// Any covariance by the distances [cells] (0..width/2, 0..height/2) on the torus; called by several threads.
using TorusCovariance = std::function<double(double dx_cells, double dy_cells)>;
Circulant circulant(TorusCovariance const& covariance, std::int64_t width, std::int64_t height, Run const& run = {});

/// Computes covariances from eigenvalues.
/// \param torus eigenvalues of a covariance
/// \return by distance on the torus
Quarter covariances(Circulant const& torus, Run const& run = {});

/// Draws a Gaussian field of mean 0 with the torus' covariance. Memory: 16 bytes a cell of the grid's height times half
/// the torus' width.
/// \param torus eigenvalues of the covariance
/// \param grid not larger than the torus
/// \param seed random seed
/// \param stage number of the stage that draws, part of the random numbers' place
/// \return the same bits for any number of threads
Raster<double> sample(Circulant const& torus, Grid const& grid, std::uint64_t seed, std::uint64_t stage,
                      Run const& run = {});

/// Multiplies two fields at once by the covariance matrix, with 0 outside their grid. Memory: 16 bytes a cell of the
/// grid's height times the torus' width. The same bits for any number of threads.
/// \param torus eigenvalues of the covariance
/// \param first,second fields of one size, not larger than the torus; replaced by the products
void multiply(Circulant const& torus, Raster<double>& first, Raster<double>& second, Run const& run = {});

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
/// \return its torus has no negative eigenvalue (up to rounding)
/// \throws BadParameter when H is outside its range, for no cells, or for more than most_torus_cells
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
/// \return the variogram is exact for all pairs of cells; the same bits for any number of threads
Raster<double> sample(FractionalSurface const& surface, std::uint64_t seed, std::uint64_t stage, Run const& run = {});

/// Sums weighted variograms: in each cell p the sum over all cells q of weights(q) |p - q|^(2H). The same bits for any
/// number of threads.
/// \param surface as fractional_surface returns it
/// \param weights by cell of the lattice; replaced by the sums
void superpose_variograms(FractionalSurface const& surface, Raster<double>& weights, Run const& run = {});

} // namespace thalweg::solver
