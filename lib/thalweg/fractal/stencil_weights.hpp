// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

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

/// Computes the weights of known neighbours for a new point and the deviation of its noise.
/// \param stencil any but exact
/// \param known at least one bit of used_neighbours(stencil)
/// \param hurst (0, 1) Hurst exponent
/// \return for kriged stencils the weights of least variance under the variogram d^(2H), and that variance; if all are
/// known, symmetric neighbours have equal weights
///
/// Source: \cite zhang, equation 14 (four); specification 1.6; ordinary kriging as in any textbook of geostatistics.
StencilWeights stencil_weights(Stencil stencil, std::uint32_t known, double hurst);

} // namespace thalweg::fractal
