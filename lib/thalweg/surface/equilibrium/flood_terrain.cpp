// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <tuple>

#include <thalweg/surface/equilibrium/internal/height_buckets.hpp>
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>

// Described in docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {
namespace {

/// Directs a bank to the river beside it and raises it above all of its cells.
void settle_bank(TerrainLevel& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    float highest = -std::numeric_limits<float>::infinity();
    float steepest = -std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        std::size_t const n = moved(i, offsets[k]);
        if (level.type[n] != CellType::river) {
            continue;
        }
        highest = std::max(highest, level.z[n]);
        if (float const slope = (level.z[i] - level.z[n]) / step_lengths[k]; slope > steepest) {
            steepest = slope;
            level.direction[i] = static_cast<std::int8_t>(k);
        }
    }
    level.z[i] = std::max(level.z[i], highest + 1.5F * level.least * level.side);
}

constexpr std::int8_t unreached = -2;

/// [least tangents] rise to a cell that a flood reaches, by its node's position, so that flow paths across flat floods
/// meander as on rough terrain.
float rise_to(std::uint8_t code) {
    constexpr unsigned steps = 16;
    constexpr float most = 4.0F;
    return 1.0F + most / steps * static_cast<float>(5U * code % steps);
}
constexpr float highest_rise = 5.0F;

/// A queue for all cells of a level.
HeightBuckets buckets_for(TerrainLevel const& level) {
    constexpr std::size_t lanes = 16; // independent extremes, which a processor compares at a time
    std::array<float, lanes> low{};
    std::array<float, lanes> high{};
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    std::size_t const cells = level.z.size();
    for (std::size_t i = 0; i < cells; i += lanes) {
        for (std::size_t k = 0; k < std::min(lanes, cells - i); ++k) {
            bool const counts = level.type[i + k] != CellType::outside;
            float const z = level.z[i + k];
            low[k] = counts && z < low[k] ? z : low[k];
            high[k] = counts && z > high[k] ? z : high[k];
        }
    }
    return {*std::min_element(low.begin(), low.end()), *std::max_element(high.begin(), high.end()), cells};
}

/// The neighbours of a cell to go to, as numbers of d8_steps.
struct Ways {
    std::array<std::uint8_t, 8> way{};
    std::size_t count = 0;
};

/// A bit for each cell: 1: no flood has reached it. Cells of the frame are always reached.
class Unreached {
public:
    explicit Unreached(TerrainLevel const& level)
        : width_(level.width), before_(static_cast<std::size_t>(level.width / 8 + 2)),
          bits_(level.direction.size() / 8 + 2 * before_, 0) {
        each_inner(level, [&](std::size_t i) {
            std::uint8_t& byte = bits_[before_ + i / 8];
            byte = static_cast<std::uint8_t>(byte | (level.direction[i] == unreached ? 1U : 0U) << i % 8);
        });
        for (unsigned bits = 0; bits < ways_.size(); ++bits) {
            for (std::size_t k = 0; k < d8_steps.size(); ++k) {
                auto const at = static_cast<unsigned>(3 * (d8_steps[k].row + 1) + d8_steps[k].col + 1);
                if ((bits >> at & 1U) != 0) {
                    ways_[bits].way[ways_[bits].count++] = static_cast<std::uint8_t>(k);
                }
            }
        }
    }

    /// \return whether it had not been reached
    bool reach(std::size_t i) {
        std::uint8_t& byte = bits_[before_ + i / 8];
        auto const bit = static_cast<std::uint8_t>(1U << i % 8);
        bool const was_unreached = (byte & bit) != 0;
        byte = static_cast<std::uint8_t>(byte & ~bit);
        return was_unreached;
    }

    /// \return of a cell and those to its left and right: bits from the left; of the frame, neighbours that lie on it
    /// are those beside it in memory
    unsigned of_three(std::int64_t i) const {
        std::uint16_t word = 0;
        std::memcpy(&word, bits_.data() + static_cast<std::int64_t>(before_) + ((i - 1) >> 3), sizeof word);
        return static_cast<unsigned>(word) >> ((i - 1) & 7) & 7U;
    }
    Ways const& around(std::int64_t i) const {
        return ways_[of_three(i - width_) | of_three(i) << 3 | of_three(i + width_) << 6];
    }

private:
    std::int64_t width_;
    std::size_t before_; ///< bytes, for the cells above the frame
    Cells<std::uint8_t> bits_;
    std::array<Ways, 512> ways_{}; ///< by bits of three rows
};

class Flood {
public:
    explicit Flood(TerrainLevel& level)
        : level_(level), offsets_(level.offsets()), closed_(!level.crests.empty()), unreached_(level),
          queue_(buckets_for(level)) {
        for (std::size_t k = 0; k < rise_.size(); ++k) {
            rise_[k] = highest_rise * level.least * level.side * step_lengths[k];
        }
        for (std::size_t i = 0; i < level.type.size(); ++i) {
            if (level.direction[i] != unreached && level.type[i] != CellType::outside) {
                queue_.push(static_cast<std::uint32_t>(i), level.z[i]);
            }
        }
    }

    void spread() {
        HeightBuckets::Taken cells;
        for (std::uint32_t count = take(cells); count > 0; count = take(cells)) {
            for (std::uint32_t const later : queue_.later()) {
                fetch_around(later);
            }
            spread_from({cells.data(), count});
        }
    }

private:
    std::uint32_t take(HeightBuckets::Taken& cells) {
        std::uint32_t const count = queue_.take(cells);
        if (count > 0 || !closed_) {
            return count;
        }
        closed_ = false; // what crests enclose drains across them
        queue_ = buckets_for(level_);
        for (std::uint32_t const crest : level_.crests) {
            if (level_.direction[crest] != unreached) {
                queue_.push(crest, level_.z[crest]);
            }
        }
        return queue_.take(cells);
    }

    /// Reaches the neighbours of cells. Lists them before, as a processor cannot foresee how many each cell has.
    void spread_from(std::span<std::uint32_t const> cells) {
        constexpr std::size_t most = 8 * (std::tuple_size_v<HeightBuckets::Taken> + 1);
        std::array<std::uint8_t, most> number; // of the cell
        std::array<std::uint8_t, most> way;
        std::size_t count = 0;
        for (std::size_t n = 0; n < cells.size(); ++n) {
            Ways const& ways = unreached_.around(cells[n]);
            std::memset(&number[count], static_cast<int>(n), ways.way.size());
            std::memcpy(&way[count], ways.way.data(), ways.way.size());
            count += ways.count;
        }
        // Bytes may lie anywhere, so that members would be read again after each is written.
        float* const z = level_.z.data();
        std::int8_t* const direction = level_.direction.data();
        bool came_to_these = false;
        for (std::size_t k = 0; k < count; ++k) {
            if (came_to_these && number[k - 1] != number[k]) {
                queue_.put_back(cells.subspan(number[k])); // those that came go first
                return;
            }
            came_to_these |= reach(cells[number[k]], way[k], z, direction);
        }
    }

    /// Asks for the rows in which spreading from a cell will write.
    void fetch_around(std::int64_t cell) const {
        for (std::int64_t const n : {cell - level_.width, cell, cell + level_.width}) {
            if (unreached_.of_three(n) != 0) {
                __builtin_prefetch(level_.direction.data() + n, 1);
                __builtin_prefetch(level_.z.data() + n);
            }
        }
    }

    /// \return whether the neighbour is to be spread from before others
    bool reach(std::uint32_t from, std::uint32_t way, float* z, std::int8_t* direction) {
        std::size_t const n = moved(from, offsets_[way]);
        if ((closed_ && level_.is_crest[from] != 0 && level_.is_crest[n] == 0) || !unreached_.reach(n)) {
            return false;
        }
        direction[n] = static_cast<std::int8_t>((way + 4) % 8);
        if (!queue_.is_above(z[n], rise_[way])) {
            float const rise = (level_.jitter ? rise_to(jitter_code(level_, n)) : 1.0F) * level_.least * level_.side;
            z[n] = std::max(z[n], z[from] + rise * step_lengths[way]);
        }
        return queue_.push(static_cast<std::uint32_t>(n), z[n]);
    }

    TerrainLevel& level_;
    std::array<std::int64_t, 8> offsets_;
    std::array<float, 8> rise_{}; ///< highest, by direction
    bool closed_;                 ///< crests give no way
    Unreached unreached_;
    HeightBuckets queue_;
};

} // namespace

void flood_terrain(TerrainLevel& level) {
    auto const offsets = level.offsets();
    level.direction.assign(level.type.size(), unreached);
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        level.direction[level.rivers.cell[n]] = level.rivers.direction[n];
    }
    each_inner(level, [&](std::size_t i) {
        if (is_bank(level.type[i])) {
            settle_bank(level, i, offsets);
        }
    });
    for (std::size_t i = 0; i < level.type.size(); ++i) {
        if (!is_land(level.type[i])) {
            level.direction[i] = level.type[i] == CellType::river ? level.direction[i] : no_direction;
        }
    }
    Flood(level).spread();
    for (std::size_t i = 0; i < level.type.size(); ++i) {
        if (level.direction[i] == unreached) {
            level.direction[i] = no_direction;
            level.type[i] = CellType::outside;
            level.z[i] = std::numeric_limits<float>::infinity();
        }
    }
}

} // namespace thalweg::surface
