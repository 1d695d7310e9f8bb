// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/network/growth/dla/internal/walk.hpp>

namespace thalweg::network {

/// How large a square around a site is free of the cluster: the Chebyshev distance to the nearest occupied site, capped
/// at 16, and the same on blocks of 16 x 16 sites and on blocks of 256 x 256.
class FreeSquares {
public:
    FreeSquares();

    /// Makes room for a cluster of this radius [cells] around the seed.
    void reach(std::int32_t radius);

    /// The cluster and its neighbours lie in the square -half <= x, y < half; free_half takes sites of a square twice
    /// as wide.
    std::int32_t half() const { return near_.half(); }

    /// Occupies a site within reach.
    void occupy(Site site);

    bool occupied(Site site) const { return near_[site] == at_hand; }

    /// Largest known L with every site of the square max(|dx|,|dy|) <= L free; 0 beside and diagonally beside the
    /// cluster. At the boundary of the square the cluster may be next door; inside it never is.
    std::int32_t free_half(Site site) const {
        // The coarse levels fit the cache, so they are asked first; and far from the cluster they are all there is.
        auto const x = static_cast<std::size_t>(site.x + 2 * half());
        auto const y = static_cast<std::size_t>(site.y + 2 * half());
        std::int32_t const blocks = at_hand - blocks_.at(x / 16, y / 16);
        if (blocks <= 1) {
            std::uint8_t const closeness = near_[site];
            return closeness > 0 ? at_hand - 1 - closeness : 15;
        }
        if (blocks < 16) {
            return 16 * (blocks - 1) + margin(x % 16, y % 16, 15);
        }
        std::int32_t const great_blocks = at_hand - great_blocks_.at(x / 256, y / 256);
        return great_blocks <= 1 ? 16 * 15 : 256 * (great_blocks - 1) + margin(x % 256, y % 256, 255);
    }

private:
    static std::int32_t margin(std::size_t x, std::size_t y, std::size_t last) {
        return static_cast<std::int32_t>(std::min(std::min(x, last - x), std::min(y, last - y)));
    }

    static constexpr std::int32_t at_hand = 16; ///< closeness of an occupied site: 16 - distance, 0 from 16 on

    /// Closeness on a square of blocks, row by row.
    struct Blocks {
        std::size_t across = 0;
        std::vector<std::uint8_t> closeness;

        explicit Blocks(std::size_t blocks_across)
            : across(blocks_across), closeness(blocks_across * blocks_across, 0) {}
        std::uint8_t at(std::size_t col, std::size_t row) const { return closeness[row * across + col]; }
        void occupy(std::size_t col, std::size_t row);
    };

    void occupy_block(std::size_t col, std::size_t row);

    TiledBytes near_;
    Blocks blocks_;
    Blocks great_blocks_;
};

} // namespace thalweg::network
