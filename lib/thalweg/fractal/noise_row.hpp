// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include <thalweg/core/run/lanes.hpp>

namespace thalweg::fractal {

enum class Noise : std::uint8_t {
    normal, ///< from 31 and 32 bits of chance for two numbers; as normal up to 6.6 deviations, where it ends
    uniform ///< in 65536 steps between -sqrt(3) and sqrt(3)
};

/// Where a row of noise belongs: to every second column of a row of the lattice that a level makes.
struct NoisePlace {
    std::uint64_t seed = 0;
    int level = 0; ///< from 1, counted from the coarse raster
    std::int64_t row = 0;
    std::int64_t odd = 0; ///< 0: the columns 0, 2, 4, ...; 1: the columns 1, 3, 5, ...
};

/// A multiple of this many numbers of a row is made at a time.
inline constexpr std::int64_t noise_batch = 32;

/// Numbers of mean 0 and variance 1, independent from place to place: a hash of seed, level, row and column.
/// \post out[i] for column 2 (first + i) + odd. The same bytes for any split of a row, and from any Lanes.
/// \param noise its distribution
/// \param place seed, level, row and column
/// \param first a multiple of noise_batch
/// \param out as many numbers as wanted, a multiple of noise_batch and 4096 at most
/// \param lanes width of the vector registers; any gives the same bytes
///
/// Source: Philox4x32-10 (\cite salmon2011), of which vector registers hold eight; \cite box1958 (normal).
void noise_row(Noise noise, NoisePlace const& place, std::int64_t first, std::span<float> out, Lanes lanes);

} // namespace thalweg::fractal
