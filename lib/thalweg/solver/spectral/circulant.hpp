// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/large_pages.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/spectral/stable_covariance.hpp>

namespace thalweg::solver {

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
/// \param run progress, log, stop token and number of threads
/// \return its eigenvalues; negative ones are set to 0
/// \throws Cancelled
///
/// Source: \cite dietrich1997; \cite wood1994.
Circulant circulant(StableCovariance const& covariance, std::int64_t width, std::int64_t height, Run const& run = {});

/// Any covariance by the distances [cells] (0..width/2, 0..height/2) on the torus; called by several threads.
using TorusCovariance = std::function<double(double dx_cells, double dy_cells)>;
Circulant circulant(TorusCovariance const& covariance, std::int64_t width, std::int64_t height, Run const& run = {});

/// Computes covariances from eigenvalues.
/// \param torus eigenvalues of a covariance
/// \param run progress, log, stop token and number of threads
/// \return by distance on the torus
Quarter covariances(Circulant const& torus, Run const& run = {});

/// Draws a Gaussian field of mean 0 with the torus' covariance. Memory: 16 bytes a cell of the grid's height times half
/// the torus' width.
/// \param torus eigenvalues of the covariance
/// \param grid not larger than the torus
/// \param seed random seed
/// \param stage number of the stage that draws, part of the random numbers' place
/// \param run progress, log, stop token and number of threads
/// \return the same bits for any number of threads
/// \throws Cancelled
Raster<double> sample(Circulant const& torus, Grid const& grid, std::uint64_t seed, std::uint64_t stage,
                      Run const& run = {});

/// Multiplies two fields at once by the covariance matrix, with 0 outside their grid. Memory: 16 bytes a cell of the
/// grid's height times the torus' width. The same bits for any number of threads.
/// \param torus eigenvalues of the covariance
/// \param first,second fields of one size, not larger than the torus; replaced by the products
/// \param run progress, log, stop token and number of threads
/// \throws Cancelled
void multiply(Circulant const& torus, Raster<double>& first, Raster<double>& second, Run const& run = {});

} // namespace thalweg::solver
