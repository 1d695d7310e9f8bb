// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: A membrane through known heights. Where heat flows between fixed cells, each free cell ends
// as the mean of its four neighbours: Laplace's equation. No height lies outside the range of the
// fixed ones, and there are no peaks or pits between them. The steady state is solved at once
// (solver/grid/poisson.hpp); explicit sweeps repeat the published computation, which reaches about
// sqrt(sweeps) cells and so stops far from it. Isolated cells make spikes: a Gaussian off the
// skeleton and 20 more sweeps take these away, and noise that fades towards the skeleton roughens
// flats.
// Source: Northeast Normal University 2015, equations 12 and 13 with the sign corrected; the steady
// state and smoothing are ours.
// Cost: O(n) for each of about 14 iterations on any grid. docs/performance.md: 85 ns and 56 bytes
// a cell to 1e-6 on 2048 x 2048. 5500 sweeps take about 20 times as long on 1024 x 1024. All cores,
// or OpenCL.
// Not for: terrain with side valleys (surface/equilibrium/). Land without skeleton between rivers
// becomes a smooth bowl or saddle, level beside ridges. Parts of a mask without any skeleton cell
// stay NaN.
// Example:
//     DiffusedDem const land_m = diffuse(skeleton_heights, {.sigma_cells = 1.5, .noise_m = 2.0});
//     Raster<float> const base = harmonic(valley); // for dilate_over
// More: docs/rivers.md, "Diffusion".

namespace thalweg::surface {

enum class Diffusion : std::uint8_t {
    steady,         ///< the limit of infinite time
    explicit_sweeps ///< as published: a given number of steps
};

/// Initial values of explicit sweeps.
enum class DiffusionStart : std::uint8_t {
    coarse, ///< the steady state on cells eight times as large
    zero    ///< as published: 0 off the skeleton
};

/// Options of diffuse().
struct DiffuseParams {
    Diffusion mode = Diffusion::steady;
    double tolerance = 1e-10;                      ///< (0, 1) steady: as in solver::PoissonParams
    double alpha = 0.25;                           ///< (0, 1/4] explicit: D dt / h^2
    int iterations = 5500;                         ///< [0, ...] explicit: sweeps
    DiffusionStart start = DiffusionStart::coarse; ///< explicit
    double sigma_cells = 1.0; ///< [cells] [0, 100] of the Gaussian smoothing off the skeleton; 0: none
    int passes = 1;           ///< [0, ...] of the smoothing
    double noise_m = 0.0;     ///< [m] >= 0 amplitude far from the skeleton
    double noise_cells = 8.0; ///< [cells] >= 1, spacing of the noise's lattice
    std::uint64_t seed = 1;   ///< of the noise
};

/// What diffuse() returns.
struct DiffusedDem {
    Raster<float> dem;     ///< [m] NaN outside
    int iterations = 0;    ///< of the solver, or sweeps
    double residual = 0.0; ///< before smoothing, relative to the norm with 0 off the skeleton
};

/// Interpolates a skeleton's heights by diffusion: du/dt = D lap u, with the skeleton fixed. Smoothing removes spikes
/// at isolated cells, 20 sweeps of diffusion then the seam beside the skeleton; noise is multiplied by 1 - exp(-d/4),
/// d: distance to the skeleton [cells]. With `inside`, a mask in the skeleton's frame, no heat flows across cells of 0,
/// and skeleton cells there do not count.
/// \param skeleton [m] heights of rivers, ridges and points; released before the solution takes its memory
/// \return skeleton cells bit for bit; before noise all heights between its lowest and highest; NaN outside and in
/// parts without skeleton cells
/// \throws BadInput for no skeleton cell (inside), an infinite height, or a mask in another frame
/// \throws BadParameter when a parameter is outside its range; above alpha = 1/4 the sweeps are unstable
/// \throws NotConverged when the solver does not reach the tolerance
///
/// Source: \cite nenu2015, equations 12 and 13, the latter with its sign corrected.
DiffusedDem diffuse(Skeleton skeleton, DiffuseParams const& params = {}, Run const& run = {});
DiffusedDem diffuse(Skeleton skeleton, Mask const& inside, DiffuseParams const& params = {}, Run const& run = {});

/// Options of harmonic().
struct HarmonicParams {
    double tolerance = 1e-8; ///< (0, 1) as in solver::PoissonParams
};

/// Interpolates a valley's heights by Laplace's equation (five-point stencil, no flux across the border): a base for
/// dilate_over, so that E = base + H(d) is smooth where the heights of rivers differ. With `inside`, a mask in the
/// valley's frame, nothing flows across cells of 0, and valley cells there do not count.
/// \param valley [m] heights of river cells; released before the solution takes its memory
/// \return valley cells bit for bit; others between their lowest and highest, to within the tolerance times the largest
/// |height| before rounding to float; NaN outside and in parts without valley cells
/// \throws BadInput for no valley cell (inside), an infinite height, or a mask in another frame
/// \throws BadParameter when the tolerance is outside its range
/// \throws NotConverged when the solver does not reach the tolerance
///
/// Source: docs/decisions/0009-harmonic-base.md.
Raster<float> harmonic(Valley valley, Run const& run = {});
Raster<float> harmonic(Valley valley, Mask const& inside, Run const& run = {});
Raster<float> harmonic(Valley valley, Mask const& inside, HarmonicParams const& params, Run const& run = {});

} // namespace thalweg::surface
