// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <array>
#include <cstdint>

#include <thalweg/core/raster.hpp>

namespace thalweg {

/// Generates random words from a seed and up to four numbers that name a place, by the counter-based Philox4x64-10
/// (Salmon et al. 2011): the same words on every machine.
/// \param seed random seed
/// \param a,b,c,d the place: stage, row, column, ...
/// \return four independent uniform 64-bit words
std::array<std::uint64_t, 4> random_block(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0,
                                          std::uint64_t d = 0);

/// Generates one random word.
/// \param seed random seed
/// \param a,b,c,d the place: stage, row, column, ...
/// \return the first word of random_block
inline std::uint64_t random_word(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0,
                                 std::uint64_t d = 0) {
    return random_block(seed, a, b, c, d)[0];
}

/// Converts a random word to a real number.
/// \param word uniform 64 bits
/// \return uniform in [0, 1), a multiple of 2^-53
inline double unit(std::uint64_t word) {
    return static_cast<double>(word >> 11) * 0x1p-53;
}

/// An endless sequence of random words for one place: those of (seed, stage, item), block by block.
class RandomStream {
public:
    RandomStream(std::uint64_t seed, std::uint64_t stage, std::uint64_t item)
        : seed_(seed), stage_(stage), item_(item) {}

    std::uint64_t word() {
        if (next_ == words_.size()) {
            refill();
        }
        return words_[next_++];
    }
    double real() { return unit(word()); }

private:
    void refill();

    std::uint64_t seed_;
    std::uint64_t stage_;
    std::uint64_t item_;
    std::uint64_t block_ = 0;
    std::array<std::uint64_t, 16> words_{};
    std::size_t next_ = 16;
};

/// Makes two independent standard normal deviates from two random words.
/// \param first,second independent uniform words
/// \return sqrt(-2 ln u) times cos(2 pi v) and sin(2 pi v), u in (0, 1], v in [0, 1); absolute values are at most 8.6
///
/// Source: \cite box1958; \cite zhang, equation 3.
std::array<double, 2> normal_pair(std::uint64_t first, std::uint64_t second);

/// Evaluates smooth noise: random numbers on a lattice, interpolated by x^2 (3 - 2 x).
/// \param seed random seed
/// \param cell where
/// \param lattice_cells [cells] >= 1, spacing of the lattice
/// \return in [-1, 1]
double value_noise(std::uint64_t seed, Cell cell, double lattice_cells);

} // namespace thalweg
