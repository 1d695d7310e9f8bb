// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/steepest_ways.hpp>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/run/parallel.hpp>

#include <array>

namespace thalweg::surface {

namespace {

std::int8_t steepest(LandLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets,
                     JitteredPerLength const& per_length) {
    float const z = level.z[i];
    int const here = level.shift[i];
    float best = 0.0F;
    std::int8_t way = level.way[i];
    for (std::size_t k = 0; k < 8; ++k) {
        std::size_t const n = moved(i, offsets[k]);
        int const change = level.shift[n] - here;
        auto const code = static_cast<std::size_t>(jitter_codes + (k < 4 ? change : -change));
        float const slope = (z - level.z[n]) * per_length[k % 4][code];
        if (slope > best) {
            best = slope;
            way = static_cast<std::int8_t>(k);
        }
    }
    return way;
}

std::int8_t steepest_river(LandLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    float best = 0.0F;
    std::int8_t way = level.way[i];
    for (std::size_t k = 0; k < 8; ++k) {
        std::size_t const n = moved(i, offsets[k]);
        float const slope = (level.z[i] - level.z[n]) * static_cast<float>(d8_per_length[k]);
        if (level.cover[n] == Cover::river && slope > best) {
            best = slope;
            way = static_cast<std::int8_t>(k);
        }
    }
    return way;
}

} // namespace

void steepest_ways(LandLevel& level, JitteredPerLength const& per_length, Run const& run) {
    auto const offsets = level.offsets();
    parallel_ranges(run, level.height - 2, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin + 1; row < end + 1; ++row) {
            auto const first = static_cast<std::size_t>(row * level.width);
            for (std::size_t i = first + 1; i + 1 < first + static_cast<std::size_t>(level.width); ++i) {
                if (is_bank(level.cover[i])) {
                    level.way[i] = steepest_river(level, i, offsets);
                } else if (is_land(level.cover[i])) {
                    level.way[i] = steepest(level, i, offsets, per_length);
                }
            }
        }
    });
}

} // namespace thalweg::surface
