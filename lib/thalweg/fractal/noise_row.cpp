// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <thalweg/fractal/midpoint.hpp>

namespace thalweg::fractal {
namespace {

/// Key and counter of Philox4x32: the first word of the counter numbers the blocks of a row.
struct Key {
    std::array<std::array<std::uint64_t, 2>, 10> rounds{};
    std::array<std::uint64_t, 3> counter{};
};

Key key_of(NoisePlace const& place) {
    Key key;
    std::uint64_t low = place.seed & 0xffffffffU;
    std::uint64_t high = place.seed >> 32;
    for (auto& round : key.rounds) {
        round = {low, high};
        low = (low + 0x9E3779B9U) & 0xffffffffU;
        high = (high + 0xBB67AE85U) & 0xffffffffU;
    }
    auto const row = static_cast<std::uint64_t>(place.row);
    key.counter = {row & 0xffffffffU, row >> 32, static_cast<std::uint64_t>(2 * std::int64_t{place.level} + place.odd)};
    return key;
}

constexpr std::int64_t longest = 4096;

static_assert(std::endian::native == std::endian::little, "slices of words are read from memory");

#define THALWEG_KERNELS <thalweg/fractal/internal/noise_lanes.inc>
#include <thalweg/core/run/lanes.inc>

} // namespace

void noise_row(Noise noise, NoisePlace const& place, std::int64_t first, std::span<float> out, Lanes lanes) {
    std::array<std::uint64_t, longest / 2> words; // NOLINT: what is read is written first
    auto const batches = static_cast<std::int64_t>(out.size()) / noise_batch;
    std::int64_t const groups = noise == Noise::uniform ? 1 : 2; // in a batch
    (lanes == Lanes::avx2 ? &avx2::make_words : &plain::make_words)(
        key_of(place), static_cast<std::uint64_t>(first / noise_batch * groups), groups * batches, words.data());
    std::int64_t const count = noise_batch * batches;
    if (noise == Noise::uniform) {
        (lanes == Lanes::avx2 ? &avx2::uniforms : &plain::uniforms)(words.data(), count, out.data());
    } else {
        (lanes == Lanes::avx2 ? &avx2::normals : &plain::normals)(words.data(), count, out.data());
    }
}

} // namespace thalweg::fractal
