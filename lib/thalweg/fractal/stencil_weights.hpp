// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace thalweg::fractal {

/// From which lattice neighbours a new point takes its mean, and how wide its noise is.
enum class Stencil : std::uint8_t {
    four,       ///< mean of the nearest; the printed factor sqrt(1 - 2^(2H-2)), which is that of a line
    four_exact, ///< the same mean; the conditional deviation of a fractional Brownian surface
    twelve,     ///< ordinary kriging, without the four farthest
    sixteen,    ///< ordinary kriging
    exact       ///< no stencil: every height at once, from all coarse cells; for midpoint alone
};

/// An offset in columns and rows.
struct Offset {
    int col = 0;
    int row = 0;
};

/// Neighbours of the centre of a square of the lattice, in halves of its side: nearest, middle, farthest.
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

/// \param straight neighbours of the centre of a square
/// \return the same neighbours of the middle of a side, where the lattice lies turned by 45 degrees.
constexpr std::array<Offset, 16> turned(std::array<Offset, 16> const& straight) {
    std::array<Offset, 16> out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = {(straight[i].col - straight[i].row) / 2, (straight[i].col + straight[i].row) / 2};
    }
    return out;
}
inline constexpr std::array<Offset, 16> around_edge = turned(around_centre);

/// \param stencil the stencil
/// \return Neighbours a stencil uses, as bits by their place in the lists above.
constexpr std::uint32_t used_neighbours(Stencil stencil) {
    return stencil == Stencil::sixteen ? 0xffff : stencil == Stencil::twelve ? 0x0fff : 0x000f;
}

/// Weights of neighbours, and the deviation of the noise.
struct StencilWeights {
    std::array<double, 16> weight{}; ///< sum 1; 0 where nothing is known
    double deviation = 0.0;          ///< of the noise, in units of sigma r^H, r the distance of the nearest neighbours
};

/// Weights of the known neighbours in the mean of a new point, and the deviation of its noise.
/// \param stencil any but exact
/// \param known some of used_neighbours(stencil), at least one
/// \param hurst in (0, 1)
/// \return for the kriged stencils the weights of least variance under the variogram d^(2H), and that variance; equal
/// weights of neighbours that lie alike when all are known.
///
/// Source: \cite zhang, equation 14 (four); specification 1.6; ordinary kriging as in any textbook of geostatistics.
StencilWeights stencil_weights(Stencil stencil, std::uint32_t known, double hurst);

} // namespace thalweg::fractal
