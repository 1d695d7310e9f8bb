// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/start_land.hpp>

#include <thalweg/core/run/parallel.hpp>
#include <thalweg/surface/equilibrium/internal/random_bytes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace thalweg::surface {

namespace {

constexpr std::uint64_t start_stage = 0x7374617274; // "start"
constexpr float first_tangent = 0.05F;

template <class Height>
void set_heights(LandLevel& level, std::uint64_t seed, float rough, Run const& run, Height height) {
    level.z.resize(static_cast<std::size_t>(level.cells()));
    parallel_ranges(run, level.height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            random_bytes(seed, start_stage, row, level.side, level.width, [&](std::int64_t col, std::uint8_t byte) {
                level.z[static_cast<std::size_t>(row * level.width + col)] =
                    height(col, row) + rough * level.side * static_cast<float>(byte) * 0x1p-8F;
            });
        }
    });
}

/// How far coarse land is moved where a finer level begins with it: valleys of coarse cells, which run straight along
/// the grid, are bent before water has settled in them.
class Bends {
public:
    Bends(LandLevel const& level, std::uint64_t seed) : across_(level.width / spacing + 2) {
        std::int64_t const down = level.height / spacing + 2;
        east_.resize(static_cast<std::size_t>(across_ * down));
        south_.resize(east_.size());
        for (std::int64_t row = 0; row < down; ++row) {
            draw(seed, 2 * row, level.side, &east_[static_cast<std::size_t>(row * across_)]);
            draw(seed, 2 * row + 1, level.side, &south_[static_cast<std::size_t>(row * across_)]);
        }
    }

    struct Shift {
        float east;  ///< [coarse cells]
        float south; ///< likewise
    };
    Shift at(std::int64_t col, std::int64_t row) const {
        auto const i = static_cast<std::size_t>(row / spacing * across_ + col / spacing);
        float const u = static_cast<float>(col % spacing) * (1.0F / spacing);
        float const v = static_cast<float>(row % spacing) * (1.0F / spacing);
        return {between(&east_[i], u, v), between(&south_[i], u, v)};
    }

private:
    static constexpr std::int64_t spacing = 6; // [cells of the level]
    static constexpr float reach = 1.0F;       // [coarse cells]

    void draw(std::uint64_t seed, std::int64_t row, float side, float* out) const {
        constexpr std::uint64_t bends = 0x62656e64; // "bend"
        random_bytes(seed, bends, row, side, across_, [&](std::int64_t col, std::uint8_t byte) {
            out[col] = reach * (static_cast<float>(byte) * 0x1p-7F - 1.0F);
        });
    }

    float between(float const* n, float u, float v) const {
        float const upper = n[0] + (n[1] - n[0]) * u;
        float const lower = n[across_] + (n[across_ + 1] - n[across_]) * u;
        return upper + (lower - upper) * v;
    }

    std::int64_t across_; ///< nodes in a row
    std::vector<float> east_;
    std::vector<float> south_;
};

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
    Bends const bends(level, seed);
    // Columns 1 and 2 (the frame is column 0) are the halves of coarse column 1 where both begin at one place.
    float const first_x = 0.25F + static_cast<float>(level.corner.col - coarse.corner.col) / coarse.side;
    float const first_y = 0.25F + static_cast<float>(level.corner.row - coarse.corner.row) / coarse.side;
    set_heights(level, seed, 0.15F, run, [&](std::int64_t col, std::int64_t row) {
        auto const [east, south] = bends.at(col, row);
        float const x = 0.5F * static_cast<float>(col) + first_x + east;
        float const y = 0.5F * static_cast<float>(row) + first_y + south;
        float const left = std::floor(x);
        float const top = std::floor(y);
        auto const c = static_cast<std::int64_t>(left);
        auto const r = static_cast<std::int64_t>(top);
        float const upper = height_at(c, r) + (height_at(c + 1, r) - height_at(c, r)) * (x - left);
        float const lower = height_at(c, r + 1) + (height_at(c + 1, r + 1) - height_at(c, r + 1)) * (x - left);
        return upper + (lower - upper) * (y - top);
    });
}

void start_rivers(LandLevel& level, std::vector<float> const& end_z) {
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
            z = !std::isnan(asked) ? asked : end_z.empty() ? 0.0F : end_z[n];
            continue;
        }
        float const below = level.z[rivers.cell[static_cast<std::size_t>(rivers.receiver[n])]];
        z = std::isnan(asked) ? std::min(z, below + first_tangent * level.side) : asked;
        z = std::max(z, below + least_tangent * level.side);
    }
}

} // namespace thalweg::surface
