// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/flood_land.hpp>

#include <algorithm>
#include <limits>
#include <vector>

namespace thalweg::surface {

namespace {

/// Cells by height, in buckets that are lists through one array.
class Buckets {
public:
    Buckets(LandLevel const& level) : next_(level.z.size()), head_(count, none) {
        float low = std::numeric_limits<float>::infinity();
        float high = -low;
        for (std::size_t i = 0; i < level.z.size(); ++i) {
            if (level.cover[i] != Cover::outside) {
                low = std::min(low, level.z[i]);
                high = std::max(high, level.z[i]);
            }
        }
        low_ = low;
        per_height_ = high > low ? static_cast<float>(count - 1) / (high - low) : 0.0F;
    }

    void push(std::size_t cell, float z) {
        float const place = std::min((z - low_) * per_height_, static_cast<float>(count - 1));
        std::size_t const bucket = std::max(at_, static_cast<std::size_t>(std::max(place, 0.0F)));
        next_[cell] = head_[bucket];
        head_[bucket] = static_cast<std::uint32_t>(cell);
    }

    /// A cell of the lowest bucket, or none.
    std::uint32_t pop() {
        while (at_ < count && head_[at_] == none) {
            ++at_;
        }
        if (at_ == count) {
            return none;
        }
        std::uint32_t const cell = head_[at_];
        head_[at_] = next_[cell];
        return cell;
    }

    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

private:
    static constexpr std::size_t count = 1 << 16;
    Cells<std::uint32_t> next_;
    std::vector<std::uint32_t> head_;
    std::size_t at_ = 0;
    float low_ = 0.0F;
    float per_height_ = 0.0F;
};

constexpr std::int8_t unreached = -2;

/// [least tangents] from a cell up to one that a flood reaches: by its node's place, so that ways across level floods
/// wind as floods on rough land do.
float rise_to(LandLevel const& level, std::size_t i) {
    constexpr unsigned steps = 16;
    constexpr float most = 4.0F;
    return level.shift.empty() ? 1.0F : 1.0F + most / steps * static_cast<float>(5U * level.shift[i] % steps);
}

/// Sends a bank to the river beside it and raises it above all of it.
void settle_bank(LandLevel& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    float highest = -std::numeric_limits<float>::infinity();
    float steepest = -std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        std::size_t const n = moved(i, offsets[k]);
        if (level.cover[n] != Cover::river) {
            continue;
        }
        highest = std::max(highest, level.z[n]);
        if (float const slope = (level.z[i] - level.z[n]) / step_lengths[k]; slope > steepest) {
            steepest = slope;
            level.way[i] = static_cast<std::int8_t>(k);
        }
    }
    level.z[i] = std::max(level.z[i], highest + 1.5F * bank_step * level.side);
}

} // namespace

void flood_land(LandLevel& level) {
    auto const offsets = level.offsets();
    level.way.assign(level.cover.size(), unreached);
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        level.way[level.rivers.cell[n]] = level.rivers.way[n];
    }
    each_inner(level, [&](std::size_t i) {
        if (is_bank(level.cover[i])) {
            settle_bank(level, i, offsets);
        }
    });
    Buckets queue(level);
    auto const last_row = level.cover.size() - static_cast<std::size_t>(level.width);
    for (std::size_t i = 0; i < level.cover.size(); ++i) {
        if (!is_land(level.cover[i])) {
            level.way[i] = level.cover[i] == Cover::river ? level.way[i] : no_way;
        }
        if (level.way[i] != unreached && level.cover[i] != Cover::outside) {
            queue.push(i, level.z[i]);
        }
    }
    auto const width = static_cast<std::size_t>(level.width);
    for (auto i = queue.pop(); i != Buckets::none; i = queue.pop()) {
        bool const top = i < width;
        bool const bottom = i >= last_row;
        bool const left = i % width == 0;
        bool const right = i % width == width - 1;
        for (std::size_t k = 0; k < offsets.size(); ++k) {
            Cell const step = d8_steps[k];
            if ((top && step.row < 0) || (bottom && step.row > 0) || (left && step.col < 0) ||
                (right && step.col > 0)) {
                continue;
            }
            std::size_t const n = moved(i, offsets[k]);
            if (level.way[n] == unreached) {
                level.way[n] = static_cast<std::int8_t>((k + 4) % 8);
                float const rise = rise_to(level, n) * least_tangent * level.side;
                level.z[n] = std::max(level.z[n], level.z[i] + rise * step_lengths[k]);
                queue.push(n, level.z[n]);
            }
        }
    }
    for (std::size_t i = 0; i < level.cover.size(); ++i) {
        if (level.way[i] == unreached) {
            level.way[i] = no_way;
            level.cover[i] = Cover::outside;
            level.z[i] = std::numeric_limits<float>::infinity();
        }
    }
}

} // namespace thalweg::surface
