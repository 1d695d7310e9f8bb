// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/fractal/noise_row.hpp>
#include <thalweg/fractal/stencil_weights.hpp>

namespace thalweg::fractal {

/// Most coarse cells with heights for Stencil::exact, which solves a dense system of them.
inline constexpr std::int64_t most_conditioning_cells = 2000;

enum class Adaptation : std::uint8_t {
    global, ///< one H and one sigma
    local   ///< those of 7 x 7 coarse cells where they are others: |H - global| > 0.1 or sigma / global outside
            ///< [0.67, 1.5]
};

/// Options of midpoint().
struct MidpointParams {
    int levels = 4;              ///< [0, 30] times each cell is halved
    std::int64_t width = 0;      ///< [cells] of the result; 0: all the coarse raster covers
    std::int64_t height = 0;     ///< [cells] the same
    std::optional<double> hurst; ///< [0.05, 0.95] H; empty: estimated from the coarse raster
    std::optional<double> sigma; ///< [m] root mean square difference one coarse cell apart; empty: estimated at that H
    Stencil stencil = Stencil::sixteen;
    Noise noise = Noise::normal;
    Adaptation adaptation = Adaptation::global;
    std::uint64_t seed = 1;
};

/// What midpoint() returns.
struct Displaced {
    Raster<float> dem;        ///< [m] NaN in holes
    double hurst = 0.5;       ///< as used
    double sigma = 0.0;       ///< [m] as used
    std::int64_t adapted = 0; ///< coarse cells with an H and sigma of their own
};

/// Fractal detail between the cells of a coarse raster, by midpoint displacement on a lattice 2^levels finer.
/// \param coarse its cells' centres become points of the lattice, the north-western one its first. NaN: a hole
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return cell (c 2^levels, r 2^levels) has the bits of coarse cell (c, r). Every other height is, level by level,
/// centres of squares first and then the middles of sides, the stencil's mean of the lattice neighbours there are, plus
/// sigma r^H times the stencil's deviation times noise; r is the distance of the nearest neighbours in coarse cells.
/// NaN exactly where all the nearest coarse cells (one, two or four) are holes. A smaller result is the north-western
/// part of a larger one, and one of fewer levels every second cell of one with more, bit for bit (global). Land that is
/// level stays so with sigma 0. With Adaptation::local, H and sigma are bilinear between coarse cells, H in steps of
/// 1/256. The same bytes for any number of threads. Stencil::exact: instead of level by level, all heights are those of
/// a fractional Brownian surface under the condition that it passes through the coarse cells (with their mean unknown),
/// on all the lattice that the coarse raster covers: any differences of heights have its variogram, without creases.
/// Fewer levels give another surface.
/// \throws BadInput no cell, a height beyond 1e30 m
/// \throws BadParameter a value out of its range, a coarse raster that does not cover the result (the message says how
/// many columns and rows would); with Stencil::exact more than 2000 coarse cells with heights, a lattice whose torus
/// has more than 2^31 cells, Noise::uniform or Adaptation::local
/// \throws Cancelled
///
/// Source: \cite zhang, equation 14 (Stencil::four); \cite fournier1982; \cite stein2002 (Stencil::exact);
/// specification 1.6.
Displaced midpoint(Raster<float> const& coarse, MidpointParams const& params = {}, Run const& run = {});

} // namespace thalweg::fractal
