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

/// Most coarse cells with data for Stencil::exact, which solves a dense system of that size.
inline constexpr std::int64_t most_conditioning_cells = 2000;

enum class Adaptation : std::uint8_t {
    global, ///< one H and one sigma
    local   ///< those of 7 x 7 coarse cells where they differ: |H - global| > 0.1 or sigma / global outside [0.67, 1.5]
};

/// Options of midpoint().
struct MidpointParams {
    int levels = 4;              ///< [0, 30] number of halvings of a cell
    std::int64_t width = 0;      ///< [cells] of the result; 0: all that the coarse raster covers
    std::int64_t height = 0;     ///< [cells] as width
    std::optional<double> hurst; ///< [0.05, 0.95] H; empty: estimated from the coarse raster
    std::optional<double> sigma; ///< [m] root mean square difference one coarse cell apart; empty: estimated at that H
    Stencil stencil = Stencil::sixteen;
    Noise noise = Noise::normal;
    Adaptation adaptation = Adaptation::global;
    std::uint64_t seed = 1;
};

/// What midpoint() returns.
struct Displaced {
    Raster<float> dem;        ///< [m] NaN: no data
    double hurst = 0.5;       ///< as used
    double sigma = 0.0;       ///< [m] as used
    std::int64_t adapted = 0; ///< coarse cells with local H and sigma
};

/// Adds fractal detail between the cells of a coarse raster by midpoint displacement, on a lattice 2^levels finer.
/// Level by level, first centres of squares and then middles of sides become the stencil's mean of their lattice
/// neighbours plus sigma r^H times the stencil's deviation times noise, r: distance of the nearest neighbours [coarse
/// cells]. Adaptation::local: H and sigma are bilinear between coarse cells, H in steps of 1/256. Stencil::exact: all
/// heights at once are a fractional Brownian surface conditioned on the coarse cells (mean unknown), without creases;
/// another number of levels gives another surface.
/// \param coarse [m] by cell; NaN: no data; cell centres become lattice points, the north-western one the first
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return cell (c 2^levels, r 2^levels) has the bits of coarse cell (c, r); NaN exactly where all nearest coarse cells
/// (one, two or four) are NaN. With Adaptation::global a smaller result is the north-western part of a larger one, and
/// one of fewer levels every second cell of one with more, bit for bit. With sigma 0 a level DEM stays level. The same
/// bytes for any number of threads.
/// \throws BadInput for no cell or a height beyond 1e30 m
/// \throws BadParameter when a value is outside its range or the coarse raster does not cover the result;
/// Stencil::exact: for more than 2000 coarse cells with data, a torus of more than 2^31 cells, Noise::uniform or
/// Adaptation::local
/// \throws Cancelled
///
/// Source: \cite zhang, equation 14 (Stencil::four); \cite fournier1982; \cite stein2002 (Stencil::exact);
/// specification 1.6.
Displaced midpoint(Raster<float> const& coarse, MidpointParams const& params = {}, Run const& run = {});

} // namespace thalweg::fractal
