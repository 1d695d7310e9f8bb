// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/detail/noise_row.hpp>

#include <thalweg/core/chance.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace thalweg::detail {
namespace {

/// Number of this stage among the places of chance.
constexpr std::uint64_t midpoint_stage = 14;
constexpr std::int64_t longest = 4096;

static_assert(std::endian::native == std::endian::little, "slices of words are read from memory");

#ifdef __clang__ // unrolls what is constant unasked, and warns of the rest
#define THALWEG_UNROLL
#else
#define THALWEG_UNROLL _Pragma("GCC unroll 8")
#endif

namespace plain {
#define THALWEG_TARGET
#define THALWEG_LANES 4
#include <thalweg/detail/noise_lanes.inc>
#undef THALWEG_TARGET
#undef THALWEG_LANES
} // namespace plain

#ifdef __x86_64__
namespace avx2 {
#define THALWEG_TARGET __attribute__((target("avx2")))
#define THALWEG_LANES 8
#include <thalweg/detail/noise_lanes.inc>
#undef THALWEG_TARGET
#undef THALWEG_LANES
} // namespace avx2
#else
namespace avx2 = plain;
#endif
#undef THALWEG_UNROLL

} // namespace

Lanes widest_lanes() {
#ifdef __x86_64__
    return __builtin_cpu_supports("avx2") ? Lanes::avx2 : Lanes::plain;
#else
    return Lanes::plain;
#endif
}

void noise_row(Noise noise, NoisePlace const& place, std::int64_t first, std::span<float> out, Lanes lanes) {
    std::array<std::uint64_t, longest / 2> words; // NOLINT: what is read is written first
    std::size_t const batches = out.size() / static_cast<std::size_t>(noise_batch);
    std::size_t const blocks = noise == Noise::uniform ? 1 : 2; // of four words, in a batch
    std::span<std::uint64_t> const used(words.data(), 4 * blocks * batches);
    chance_blocks(place.seed, midpoint_stage, static_cast<std::uint64_t>(2 * place.level + place.odd),
                  static_cast<std::uint64_t>(place.row),
                  static_cast<std::uint64_t>(first / noise_batch) * static_cast<std::uint64_t>(blocks), used);
    auto const count = static_cast<std::int64_t>(noise_batch * static_cast<std::int64_t>(batches));
    if (noise == Noise::uniform) {
        (lanes == Lanes::avx2 ? &avx2::uniforms : &plain::uniforms)(used.data(), count, out.data());
    } else {
        (lanes == Lanes::avx2 ? &avx2::normals : &plain::normals)(used.data(), count, out.data());
    }
}

} // namespace thalweg::detail
