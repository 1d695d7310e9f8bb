// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/lanes.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: Fractal detail between coarse cells. Level by level the lattice is halved: first centres of
// squares, then middles of sides become a mean of their neighbours plus noise, whose deviation
// falls by 2^-H with each halving, as differences of a fractional Brownian surface do. The
// published mean of four neighbours leaves creases and misses the dimension; sixteen neighbours,
// weighted by ordinary kriging under the variogram d^(2H), with the kriging variance for the noise,
// do not. `exact` draws the whole surface at once and moves it to the coarse cells by kriging.
// Noise is a hash of level and place, so that parts and coarser results agree bit for bit.
// Source: Fournier, Fussell and Carpenter 1982; Zhang, Liu and Li, equation 14; Stein 2002
// (`exact`). Sixteen neighbours are ours.
// Cost: O(n) for n cells of the result. docs/performance.md: 1.2 ns and 5.2 bytes a cell for 8192 x
// 8192, 3.6 times a memcpy. Bands of rows run on all cores. `exact` takes about 60 times as long, 140
// times above an H of 0.75, and solves a dense system of its coarse cells (2000 at most).
// Not for: erosion: the detail has no valleys and as many pits as peaks. H estimated from few
// coarse cells says little.
// Example:
//     DisplacedDem const fine = midpoint(dem, {.levels = 3, .hurst = 0.7, .seed = 5});
//     Raster<float> const& dem_m = fine.dem; // every 8th cell has the bits of `dem`
// More: docs/statistics.md, "What the numbers mean".

namespace thalweg::fractal {

/// The lattice neighbours whose mean a new point takes, and the deviation of its noise.
enum class Stencil : std::uint8_t {
    four,       ///< mean of the nearest; the published factor sqrt(1 - 2^(2H-2)), that of a line
    four_exact, ///< the same mean; the conditional deviation of a fractional Brownian surface
    twelve,     ///< ordinary kriging, without the four farthest
    sixteen,    ///< ordinary kriging
    exact       ///< no stencil: every height at once, from all coarse cells; for midpoint only
};

/// An offset in columns and rows.
struct Offset {
    int col = 0;
    int row = 0;
};

/// Neighbours of the centre of a square of the lattice, in half sides: nearest, middle, farthest.
inline constexpr std::array<Offset, 16> around_centre = {{{-1, -1},
                                                          {1, -1},
                                                          {-1, 1},
                                                          {1, 1},
                                                          {-1, -3},
                                                          {1, -3},
                                                          {-3, -1},
                                                          {3, -1},
                                                          {-3, 1},
                                                          {3, 1},
                                                          {-1, 3},
                                                          {1, 3},
                                                          {-3, -3},
                                                          {3, -3},
                                                          {-3, 3},
                                                          {3, 3}}};

/// Rotates neighbours by 45 degrees, for the middle of a side.
/// \param straight neighbours of the centre of a square
/// \return in the same order
constexpr std::array<Offset, 16> turned(std::array<Offset, 16> const& straight) {
    std::array<Offset, 16> out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = {(straight[i].col - straight[i].row) / 2, (straight[i].col + straight[i].row) / 2};
    }
    return out;
}
inline constexpr std::array<Offset, 16> around_edge = turned(around_centre);

/// Finds the neighbours that a stencil uses.
/// \param stencil any
/// \return bits by position in around_centre
constexpr std::uint32_t used_neighbours(Stencil stencil) {
    return stencil == Stencil::sixteen ? 0xffff : stencil == Stencil::twelve ? 0x0fff : 0x000f;
}

/// Weights of neighbours and deviation of the noise.
struct StencilWeights {
    std::array<double, 16> weight{}; ///< sum 1; 0: unknown neighbour
    double deviation = 0.0;          ///< in units of sigma r^H, r: distance of the nearest neighbours
};

/// \internal
/// Computes the weights of known neighbours for a new point and the deviation of its noise.
/// \param stencil any but exact
/// \param known at least one bit of used_neighbours(stencil)
/// \param hurst (0, 1) Hurst exponent
/// \return for kriged stencils the weights of least variance under the variogram d^(2H), and that variance; if all are
/// known, symmetric neighbours have equal weights
///
/// Source: \cite zhang, equation 14 (four); ordinary kriging as in any textbook of geostatistics.
StencilWeights stencil_weights(Stencil stencil, std::uint32_t known, double hurst);

enum class Noise : std::uint8_t {
    normal, ///< from 31 and 32 random bits for two numbers; truncated at 6.6 deviations
    uniform ///< in 65536 steps between -sqrt(3) and sqrt(3)
};

/// The place of a row of noise: every second column of a lattice row of one level.
struct NoisePlace {
    std::uint64_t seed = 0;
    int level = 0; ///< from 1, counted from the coarse raster
    std::int64_t row = 0;
    std::int64_t odd = 0; ///< 0: the columns 0, 2, 4, ...; 1: the columns 1, 3, 5, ...
};

/// Batch size: noise is made in multiples of this.
inline constexpr std::int64_t noise_batch = 32;

/// \internal
/// Fills a row with numbers of mean 0 and variance 1, independent from place to place: a hash of seed, level, row and
/// column. The same bytes for any split of a row and any Lanes.
/// \param noise distribution
/// \param place seed, level, row and parity of columns
/// \param first a multiple of noise_batch
/// \param out out[i] receives the number of column 2 (first + i) + odd; size a multiple of noise_batch, at most 4096
/// \param lanes instruction set; the bytes are the same for each
///
/// Source: Philox4x32-10 (\cite salmon2011), of which vector registers hold eight; \cite box1958 (normal).
void noise_row(Noise noise, NoisePlace const& place, std::int64_t first, std::span<float> out, Lanes lanes);

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
struct DisplacedDem {
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
/// \return cell (c 2^levels, r 2^levels) has the bits of coarse cell (c, r); NaN exactly where all nearest coarse cells
/// (one, two or four) are NaN. With Adaptation::global a smaller result is the north-western part of a larger one, and
/// one of fewer levels every second cell of one with more, bit for bit. With sigma 0 a level DEM stays level. The same
/// bytes for any number of threads.
/// \throws BadInput for no cell or a height beyond 1e30 m
/// \throws BadParameter when a value is outside its range or the coarse raster does not cover the result;
/// Stencil::exact: for more than 2000 coarse cells with data, a torus of more than 2^31 cells, Noise::uniform or
/// Adaptation::local
///
/// Source: \cite zhang, equation 14 (Stencil::four); \cite fournier1982; \cite stein2002 (Stencil::exact).
DisplacedDem midpoint(Raster<float> const& coarse, MidpointParams const& params = {}, Run const& run = {});

} // namespace thalweg::fractal
