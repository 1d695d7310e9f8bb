// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/skeleton.hpp>

namespace thalweg::surface {

enum class Diffusion : std::uint8_t {
    steady,         ///< its end: what it is after any time
    explicit_sweeps ///< as printed: as many steps as asked for
};

/// Where explicit sweeps begin.
enum class DiffusionStart : std::uint8_t {
    coarse, ///< the steady state on cells eight times as large
    zero    ///< as printed: 0 everywhere off the skeleton
};

/// Options of diffuse().
struct DiffuseParams {
    Diffusion mode = Diffusion::steady;
    double tolerance = 1e-10;                      ///< (0,1) steady: as solver::PoissonParams
    double alpha = 0.25;                           ///< (0,1/4] explicit: D dt / h^2
    int iterations = 5500;                         ///< [0, ...] explicit: sweeps
    DiffusionStart start = DiffusionStart::coarse; ///< explicit
    double sigma_cells = 1.0;                      ///< [cells] [0,100] of the Gaussian mean off the skeleton; 0: none
    int passes = 1;                                ///< [0, ...] of the mean
    double noise_m = 0.0;                          ///< [m] >= 0 amplitude far from the skeleton
    double noise_cells = 8.0;                      ///< [cells] >= 1 between the numbers that make the noise
    std::uint64_t seed = 1;                        ///< of the noise
};

/// What diffuse() returns.
struct Diffused {
    Raster<float> dem;     ///< [m] NaN outside
    int iterations = 0;    ///< of the solver, or sweeps
    double residual = 0.0; ///< reached before smoothing, of the norm with 0 off the skeleton
};

/// Spreads the skeleton's heights over the land as heat spreads: du/dt = D lap u with the skeleton kept.
/// \param skeleton heights of rivers, ridges and points. inside: of its frame; cells with 0 are holes across which
/// nothing flows, and a skeleton cell there does not count
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return skeleton cells exact; before noise all heights between its lowest and highest; NaN outside and in parts that
/// hold no skeleton cell. The mean over neighbours takes the spikes from lonely cells; the skeleton is kept in each
/// pass and 20 sweeps of diffusion then take the seam beside it. Noise is multiplied by 1 - exp(-d/4), d the distance
/// to the skeleton in cells.
/// \throws BadInput no skeleton cell (inside), an infinite height, another frame
/// \throws BadParameter out of range, alpha above 1/4 too, for then differences grow from sweep to sweep
/// \throws NotConverged
/// \throws Cancelled
///
/// Source: \cite nenu2015, equations 12 and 13, the latter with its sign mended; specification 3.7.
Diffused diffuse(Skeleton const& skeleton, DiffuseParams const& params = {}, Run const& run = {});
Diffused diffuse(Skeleton const& skeleton, Mask const& inside, DiffuseParams const& params = {}, Run const& run = {});

} // namespace thalweg::surface
