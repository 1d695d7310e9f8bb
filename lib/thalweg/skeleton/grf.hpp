// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/spectral/stable_covariance.hpp>

namespace thalweg::skeleton {

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
        0.0; ///< of the torus' eigenvalues that were set to 0: how far the covariance is from the one asked for
};

/// Draws a stationary Gaussian random field with given correlation lengths and fractal dimension, by circulant
/// embedding; if negative_share is above 1e-6 the torus is doubled once. Memory: about 8 bytes a cell of half the torus
/// (embedding 4: 64 bytes a cell of a grid much wider than L).
/// \param grid of the result
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return heights whose correlation at (dx, dy) cells is exp(-((dx/lx)^2 + (dy/ly)^2)^(3 - dimension)), exact but for
/// negative_share; the same bits for any number of threads
/// \throws BadParameter when a parameter is outside its range or the torus has more than 2^32 cells
/// \throws Cancelled
///
/// Source: \cite zhang, section 2; circulant embedding by \cite dietrich1997.
RandomField grf(Grid const& grid, GrfParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
