// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/start_land.hpp>

#include <thalweg/core/parallel.hpp>
#include <thalweg/surface/chance_bytes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::surface {

namespace {

constexpr std::uint64_t stage = 0x7374617274; // "start"
constexpr float first_tangent = 0.05F;

template <class Height>
void set_heights(LandLevel& level, std::uint64_t seed, float rough, Run const& run, Height height) {
    level.z.resize(static_cast<std::size_t>(level.cells()));
    parallel_ranges(run, level.height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            chance_bytes(seed, stage, row, level.side, level.width, [&](std::int64_t col, std::uint8_t byte) {
                level.z[static_cast<std::size_t>(row * level.width + col)] =
                    height(col, row) + rough * level.side * static_cast<float>(byte) * 0x1p-8F;
            });
        }
    });
}

} // namespace

void start_from_nothing(LandLevel& level, NearestRiver const& near, std::uint64_t seed, Run const& run) {
    set_heights(level, seed, 0.3F, run, [&](std::int64_t col, std::int64_t row) {
        float const far = near.distance[static_cast<std::size_t>(row * level.width + col)];
        auto const rim = static_cast<float>(std::min({col, row, level.width - 1 - col, level.height - 1 - row}));
        return first_tangent * level.side * std::min(far, rim);
    });
}

void start_from(LandLevel& level, LandLevel const& coarse, std::uint64_t seed, Run const& run) {
    // A frame of infinite heights must not be mixed in: the outermost inner cells stand for it.
    auto const held = [](std::int64_t at, std::int64_t size) { return std::clamp<std::int64_t>(at, 1, size - 2); };
    auto const height_at = [&](std::int64_t col, std::int64_t row) {
        float const z =
            coarse.z[static_cast<std::size_t>(held(row, coarse.height) * coarse.width + held(col, coarse.width))];
        return std::isinf(z) ? 0.0F : z;
    };
    set_heights(level, seed, 0.15F, run, [&](std::int64_t col, std::int64_t row) {
        // An odd column (the frame is column 0) is the left half of a coarse cell.
        std::int64_t const c = (col + 1) / 2;
        std::int64_t const r = (row + 1) / 2;
        std::int64_t const to_c = col % 2 != 0 ? c - 1 : c + 1;
        std::int64_t const to_r = row % 2 != 0 ? r - 1 : r + 1;
        return 0.5625F * height_at(c, r) + 0.1875F * (height_at(to_c, r) + height_at(c, to_r)) +
               0.0625F * height_at(to_c, to_r);
    });
}

void start_rivers(LandLevel& level) {
    for (std::size_t i = 0; i < level.cover.size(); ++i) {
        if (level.cover[i] == Cover::sea) {
            level.z[i] = 0.0F;
        } else if (level.cover[i] == Cover::outside) {
            level.z[i] = std::numeric_limits<float>::infinity();
        }
    }
    RiverCells const& rivers = level.rivers;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        float& z = level.z[rivers.cell[n]];
        float const asked = rivers.asked.empty() ? std::nanf("") : rivers.asked[n];
        if (rivers.receiver[n] < 0) {
            z = std::isnan(asked) ? 0.0F : asked;
            continue;
        }
        float const below = level.z[rivers.cell[static_cast<std::size_t>(rivers.receiver[n])]];
        z = std::isnan(asked) ? std::min(z, below + first_tangent * level.side) : asked;
        z = std::max(z, below + least_tangent * level.side);
    }
}

} // namespace thalweg::surface
