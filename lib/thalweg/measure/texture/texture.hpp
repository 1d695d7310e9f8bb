// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/route.hpp>

// Idea: Real slopes form faces: neighbouring cells face the same way, spurs repeat at some
// distance, and ridges have a direction. Only the direction of the gradient tells that, so
// gradients are scaled to length 1. Their autocorrelation at three lags tells how large faces are.
// Within a Gaussian window the mean of their outer products (the structure tensor) has two equal
// eigenvalues where slopes face all ways and one is 0 where all ridges are parallel: the difference
// over the sum is the anisotropy. Opposite sides of a ridge add up, since the product is the same
// for both. straight_channels looks for the opposite fault, valleys that follow the grid.
// Source: Bigün and Granlund 1987 (structure tensor). Lags, windows and straight channels are ours:
// docs/relief_measures.md.
// Cost: O(n), a few rows of memory: gradients are computed anew where they are read, and tensors
// averaged over blocks of an eighth of the window before they are smoothed. straight_channels
// O(channel cells reach_steps). Rows run on all cores; the same bits for any number of threads.
// Not for: DEMs smaller than four windows, whose anisotropy is NaN. DEMs of different cell sizes: a
// gradient spans two cells, so that the finer DEM shows finer faces.
// Example:
//     GradientTexture const texture = gradient_texture(dem, {.window_m = 960.0});
//     StraightChannels const channels = straight_channels(flow_field, {.reach_steps = 60});
//     double const at_360_m = texture.correlation[0];
// More: docs/relief_measures.md, "Methods".

namespace thalweg::measure {

inline constexpr std::array<double, 3> texture_lags_m = {360.0, 720.0, 1440.0};

/// Whether the slopes of a DEM are organised into faces, ridges and spurs; NaN: the DEM is too small.
struct GradientTexture {
    /// [-1, 1] autocorrelation of the unit gradient at texture_lags_m, mean of rows and columns
    std::array<double, texture_lags_m.size()> correlation{};
    /// [0, 1] anisotropy of the structure tensor: 0 as many slopes in every direction, 1 parallel ridges
    double anisotropy = std::numeric_limits<double>::quiet_NaN();
};

/// Options of gradient_texture().
struct GradientTextureParams {
    double window_m = 960.0; ///< [m] > 0, standard deviation of the Gaussian window of the structure tensor
};

/// Measures the autocorrelation of unit gradients (central differences; level cells left out) and the mean of
/// |l1 - l2| / (l1 + l2) of the structure tensor's eigenvalues, where the window lies on the DEM. The tensor is
/// averaged over blocks of an eighth of the window first.
/// \param dem [m] by cell; NaN: no data
/// \return NaN where a lag or the window is shorter than a cell, or longer than the DEM; the same bits for any number
/// of threads
/// \throws BadParameter when window_m is not positive
/// \throws BadInput when the cell size is not positive
///
/// Source: \cite bigun1987 (structure tensor).
GradientTexture gradient_texture(Raster<float> const& dem, GradientTextureParams const& params = {},
                                 Run const& run = {});

/// How straight the channels of a DEM run.
struct StraightChannels {
    std::int64_t longest_run = 0; ///< [steps] in one D8 direction
    std::int64_t reaches = 0;     ///< of reach_steps, one from each channel cell with a flow path that long
    /// [0, 1] of the reaches stay within tolerance_cells of their chord; NaN: no reach
    double straight_share = std::numeric_limits<double>::quiet_NaN();
};

/// Options of straight_channels().
struct StraightChannelsParams {
    std::int64_t support_cells = 2000; ///< [1, ...] contributing area at which channels begin
    std::int64_t reach_steps = 60;     ///< [2, ...]
    double tolerance_cells = 1.5;      ///< [cells] >= 0
};

/// Measures how far channels run straight: valleys that follow the grid do so for hundreds of cells.
/// \param drainage flow field of the DEM
/// \return lengths in cells of the flow field
/// \throws BadParameter when a parameter is outside its range
StraightChannels straight_channels(flow::FlowField const& drainage, StraightChannelsParams const& params = {},
                                   Run const& run = {});

/// The same without level water: a cell as high as its eight neighbours is a lake's surface, which flow crosses in
/// straight lines that no channel takes. Runs and reaches end at lakes.
/// \param dem [m] by cell
/// \throws BadInput when the DEM has another grid
StraightChannels straight_channels(flow::FlowField const& drainage, Raster<float> const& dem,
                                   StraightChannelsParams const& params = {}, Run const& run = {});

} // namespace thalweg::measure
