// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/jitter.hpp>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/surface/equilibrium/internal/random_bytes.hpp>

#include <cmath>

namespace thalweg::surface {

namespace {
constexpr std::uint64_t jitter_stage = 0x6a6974746572; // "jitter"
constexpr double reach = 0.35;                         // [cells]
} // namespace

JitteredPerLength jittered_per_length() {
    JitteredPerLength out{};
    constexpr double step = 2.0 * reach / (jitter_places - 1);
    for (std::size_t k = 0; k < out.size(); ++k) {
        for (int east = 1 - jitter_places; east < jitter_places; ++east) {
            for (int south = 1 - jitter_places; south < jitter_places; ++south) {
                double const x = static_cast<double>(d8_steps[k].col) + step * east;
                double const y = static_cast<double>(d8_steps[k].row) + step * south;
                out[k][static_cast<std::size_t>(east * jitter_stride + south + jitter_codes)] =
                    static_cast<float>(1.0 / std::sqrt(x * x + y * y));
            }
        }
    }
    return out;
}

void jitter(LandLevel& level, std::uint64_t seed, Run const& run) {
    level.shift.resize(static_cast<std::size_t>(level.cells()));
    parallel_ranges(run, level.height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            std::uint8_t* const codes = &level.shift[static_cast<std::size_t>(row * level.width)];
            random_bytes(seed, jitter_stage, row, level.side, level.width, [&](std::int64_t col, std::uint8_t byte) {
                codes[col] = static_cast<std::uint8_t>((byte & 7U) * jitter_stride + ((byte >> 3U) & 7U));
            });
        }
    });
}

} // namespace thalweg::surface
