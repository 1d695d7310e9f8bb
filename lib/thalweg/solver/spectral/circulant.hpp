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

/// Numbers at the distances (0..width/2, 0..height/2) on a torus, row by row; the rest of the torus mirrors them.
using Quarter = std::vector<double, LargePages<double>>;

/// A covariance on a torus by its eigenvalues, none of them negative.
struct Circulant {
    std::int64_t width = 0;  ///< [cells] even
    std::int64_t height = 0; ///< [cells] even
    Quarter eigenvalues;
    double negative_share = 0.0; ///< sum of the eigenvalues that were negative and are now 0, to that of all
};

/// The eigenvalues of a covariance on a torus.
/// \pre width and height [cells], even and at least 2.
/// \param covariance the covariance
/// \param width [cells] number of columns
/// \param height [cells] number of rows
/// \param run progress, log, stop token and number of threads
/// \return those of the covariance at the shorter way round; negative ones are set to 0. Holds 2 bytes a cell of the
/// torus.
/// \throws Cancelled
///
/// Source: \cite dietrich1997; \cite wood1994.
Circulant circulant(StableCovariance const& covariance, std::int64_t width, std::int64_t height, Run const& run = {});

/// The same for any covariance at the distances [cells] (0..width/2, 0..height/2) of the torus; several threads call
/// it.
using TorusCovariance = std::function<double(double dx_cells, double dy_cells)>;
Circulant circulant(TorusCovariance const& covariance, std::int64_t width, std::int64_t height, Run const& run = {});

/// \param torus the eigenvalues
/// \param run progress, log, stop token and number of threads
/// \return the covariances that belong to the eigenvalues.
Quarter covariances(Circulant const& torus, Run const& run = {});

/// A field of mean 0 with the torus' covariance on a corner of it.
/// \pre a grid no larger than the torus; seed and stage, which name the random numbers.
/// \param torus the embedding torus
/// \param grid the grid
/// \param seed random seed
/// \param stage number of the stage that draws
/// \param run progress, log, stop token and number of threads
/// \return jointly normal numbers, the same bits for any number of threads. Holds 16 bytes a cell of the grid's height
/// times half the torus' width.
/// \throws Cancelled
Raster<double> sample(Circulant const& torus, Grid const& grid, std::uint64_t seed, std::uint64_t stage,
                      Run const& run = {});

/// The covariance matrix times two fields at once: what stands outside their grid counts as 0.
/// \post each product in the place of its field; the same bits for any number of threads. Holds 16 bytes a cell of the
/// grid's height times the torus' width.
/// \pre fields of one size, no larger than the torus.
/// \param torus the embedding torus
/// \param first a field; receives its product
/// \param second a field; receives its product
/// \param run progress, log, stop token and number of threads
/// \throws Cancelled
void multiply(Circulant const& torus, Raster<double>& first, Raster<double>& second, Run const& run = {});

} // namespace thalweg::solver
