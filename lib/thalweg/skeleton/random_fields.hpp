// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

// Idea: Random terrain with given mean, deviation and correlation lengths. grf: a stationary
// Gaussian field whose covariance is a stretched exponential, so that lengths (1/e) and fractal
// dimension are free; drawn exactly by Fourier transform on a torus
// (solver/spectral/circulant.hpp). separable_ar: each height from its western, northern and
// north-western neighbours, which gives an exactly exponential, separable correlation in one pass,
// of dimension 2.5. markov3: the published recursion from two neighbours, whose correlation is
// shorter than asked and differs between the diagonals.
// Source: Zhang, Liu and Li, section 2 and equations 1 to 3; Dietrich and Newsam 1997.
// Cost: grf O(n log n) on a torus of about 16 times the grid (64 bytes a cell of a grid much wider
// than L); separable_ar and markov3 O(n). Transforms, rows and columns run on all cores, markov3's
// recursion on one.
// Not for: one terrain that has to have the numbers: a realisation has them only in expectation
// (fractal/match_statistics.hpp moves it there). markov3 is for comparison with the paper. No field
// has valleys.
// Example:
//     RandomField const field = grf(grid, {.std = 120.0, .covariance = {20.0, 40.0, 2.4}});
//     Raster<float> const rough = separable_ar(grid, {.std = 120.0, .lx_cells = 20.0});
// More: docs/statistics.md.

namespace thalweg::skeleton {

/// The statistics of a random terrain in expectation; a realisation departs from them.
struct FieldParams {
    double mean = 0.0;      ///< [m]
    double std = 1.0;       ///< [m] >= 0
    double lx_cells = 20.0; ///< [cells] > 0, correlation length along rows
    double ly_cells = 20.0; ///< [cells] > 0, correlation length along columns
    std::uint64_t seed = 0;
};

/// \internal
/// Checks the statistics of a random terrain.
/// \param params any values
/// \param stage name of the stage, for messages
/// \throws BadParameter when a field is outside its range or not finite
void check(FieldParams const& params, char const* stage);

/// Options of grf().
struct GrfParams {
    double mean = 0.0; ///< [m]
    double std = 1.0;  ///< [m] >= 0
    solver::StableCovariance covariance{};
    std::uint64_t seed = 0;
    int embedding =
        4; ///< [1, 64] the torus is at least this factor times max(N, 5 L) wide; less memory, more negative_share
};

/// What grf() returns: a stationary Gaussian random field.
struct RandomField {
    Raster<float> dem;
    std::int64_t torus_width = 0;  ///< [cells]
    std::int64_t torus_height = 0; ///< [cells]
    double negative_share =
        0.0; ///< of the torus' eigenvalues that were set to 0: deviation from the requested covariance
};

/// Draws a stationary Gaussian random field with given correlation lengths and fractal dimension, by circulant
/// embedding; if negative_share is above 1e-6 the torus is doubled once. Memory: about 8 bytes a cell of half the torus
/// (embedding 4: 64 bytes a cell of a grid much wider than L).
/// \param grid of the result
/// \return heights whose correlation at (dx, dy) cells is exp(-((dx/lx)^2 + (dy/ly)^2)^(3 - dimension)), exact but for
/// negative_share; the same bits for any number of threads
/// \throws BadParameter when a parameter is outside its range or the torus has more than 2^32 cells
///
/// Source: \cite zhang, section 2; circulant embedding by \cite dietrich1997.
RandomField grf(Grid const& grid, GrfParams const& params = {}, Run const& run = {});

/// Draws terrain by the recursion of Zhang, Liu and Li, for comparison: each height from its neighbours to the west and
/// north. The correlation length is not L = (lx + ly)/2 but that of ((1 - sqrt(1 - 4 A^2))/(2 A))^k, 5.7 cells for L =
/// 20, and it differs between the diagonals: use grf or separable_ar where it matters.
/// \param grid of the result
/// \return h(i,j) = A (h(i,j-1) + h(i-1,j)) + sqrt(1 - 2 rho^2/(1 + rho1)) R, A = rho/(1 + rho1), rho = exp(-1/L), rho1
/// = exp(-sqrt(2)/L), after a lead of 5 L rows and columns, scaled to the deviation std; the mean is added at the end,
/// where the published equation would multiply it
/// \throws BadParameter when a parameter is outside its range
///
/// Source: \cite zhang, equations 1 to 3.
Raster<float> markov3(Grid const& grid, FieldParams const& params = {}, Run const& run = {});

/// Draws a Gaussian random field with exponential, separable correlation, by autoregression along rows and columns.
/// \param grid of the result
/// \return heights whose correlation at (dx, dy) cells is exp(-dx/lx) exp(-dy/ly), exact from the first cell: h(i,j) =
/// a h(i,j-1) + b h(i-1,j) - a b h(i-1,j-1) + std sqrt((1-a^2)(1-b^2)) e, a = exp(-1/lx), b = exp(-1/ly). Its fractal
/// dimension is 2.5. The same bits for any number of threads.
/// \throws BadParameter when a parameter is outside its range
///
/// Source: \cite zhang, section 2 ("approximately exponential and separable").
Raster<float> separable_ar(Grid const& grid, FieldParams const& params = {}, Run const& run = {});

/// Shifts a DEM vertically to a given mean.
/// \param dem [m] by cell; NaN: no data
/// \param mean [m] of the result
/// \return each height plus the same difference
/// \throws BadParameter when mean is not a number
///
/// Source: \cite zhang, equation 5.
Raster<float> shift_mean(Raster<float> dem, double mean);

} // namespace thalweg::skeleton
