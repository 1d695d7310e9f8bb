// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include <thalweg/core/run/lanes.hpp>

namespace thalweg::fractal {

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

} // namespace thalweg::fractal
