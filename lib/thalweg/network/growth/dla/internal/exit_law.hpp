// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/numbers/random.hpp>

namespace thalweg::network {

/// Where the simple random walk of the lattice, started in the centre of a square, first meets the square's boundary.
/// The square of half side L is max(|x|,|y|) <= L. By the reflection principle and separation of variables the site
/// (L, j) has the probability
///     p(j) = 1/(2L) sum over odd k < 2L of cos(k pi j / 2L) / cosh(L a_k),   sinh(a_k / 2) = sin(k pi / 4L),
/// and so have its images on the other sides; the corners cannot be reached.
/// Gives: p(j) for j = 0 ... L-1, summing to 1/4 over the side; terms below 1e-19 are left out.
/// half: [1, ...] L. Source: McCrea and Whipple 1940, Proc. R. Soc. Edinburgh 60.
std::vector<double> exit_probabilities(int half);

/// The law above as alias tables (Walker 1977), for the half sides 1 ... 31, 32 ... 248 in steps of
/// 8, 256 ... 960 in steps of 64 and 1024 ... 3840 in steps of 256.
class ExitLaw {
public:
    struct Offset {
        std::int32_t x;
        std::int32_t y;
    };

    /// Makes the tables of all half sides up to this one.
    void prepare(int longest);

    /// Leaves the largest square that has a table and a half side of at most `free`; [1, ...].
    Offset leave(int free, RandomStream& random) const {
        Table const& table = tables_[slot(free < longest_ ? free : longest_)];
        std::uint64_t const word = random.word();
        std::uint64_t const spot = (word >> 12) * table.half;
        std::uint64_t const entry = table.entries[spot >> 52];
        std::uint64_t const along = (spot & low_52_bits) < entry >> 12 ? spot >> 52 : entry & low_12_bits;
        auto const shift = static_cast<std::int32_t>((word & 1) != 0 ? along : 0 - along);
        auto const side = static_cast<std::int32_t>((word & 2) != 0 ? table.half : 0 - table.half);
        return (word & 4) != 0 ? Offset{side, shift} : Offset{shift, side};
    }

    /// Half side of the square that leave(free) takes.
    int half_side(int free) const { return static_cast<int>(tables_[slot(free < longest_ ? free : longest_)].half); }

private:
    static constexpr std::uint64_t low_52_bits = (std::uint64_t{1} << 52) - 1;
    static constexpr std::uint64_t low_12_bits = (std::uint64_t{1} << 12) - 1;

    struct Table {
        std::uint64_t half = 0;
        std::vector<std::uint64_t> entries; ///< by |offset|: 52 bits of the share it keeps, 12 bits of its alias
    };

    static std::size_t slot(int free) {
        auto const f = static_cast<std::size_t>(free);
        return f < 32 ? f : f < 256 ? 28 + f / 8 : f < 1024 ? 56 + f / 64 : 68 + (f < 4096 ? f / 256 : 15);
    }
    static Table make_table(int half);

    std::array<Table, 84> tables_; ///< by slot; slot 0 stays empty
    int longest_ = 0;              ///< tables stand for every half side up to it
};

} // namespace thalweg::network
