// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

#include <thalweg/network/growth/dla/internal/walk.hpp>

namespace thalweg::network {

/// One byte a site on a square around the seed, 0 at first, kept in tiles of 16 x 16 sites so that neighbours above and
/// below lie on the same page. Memory the walk never reaches is never touched.
class TiledBytes {
public:
    static constexpr std::int32_t tile = 16;
    static constexpr std::size_t sites = 256; ///< of a tile

    /// half: [16, ...] a multiple of 16; the sites are -half <= x, y < half.
    explicit TiledBytes(std::int32_t half)
        : half_(half), across_(static_cast<std::size_t>(2 * half / tile)),
          bytes_(static_cast<std::uint8_t*>(std::calloc(across_ * across_, sites))) {
        if (bytes_ == nullptr) {
            throw std::bad_alloc();
        }
    }

    std::int32_t half() const { return half_; }
    std::size_t tiles_across() const { return across_; }

    std::uint8_t& operator[](Site s) { return bytes_.get()[index(s)]; }
    std::uint8_t operator[](Site s) const { return bytes_.get()[index(s)]; }

    /// The 256 bytes of a tile, row by row.
    std::uint8_t* tile_at(std::size_t col, std::size_t row) {
        return bytes_.get() + (row * across_ + col) * tile * tile;
    }
    std::uint8_t const* tile_at(std::size_t col, std::size_t row) const {
        return bytes_.get() + (row * across_ + col) * tile * tile;
    }

    /// Widens the square; what stands in it stays where it is.
    void widen(std::int32_t half) {
        TiledBytes wider(half);
        auto const shift = static_cast<std::size_t>((half - half_) / tile);
        for (std::size_t row = 0; row < across_; ++row) {
            std::copy_n(tile_at(0, row), across_ * tile * tile, wider.tile_at(shift, row + shift));
        }
        *this = std::move(wider);
    }

private:
    struct Free {
        void operator()(std::uint8_t* p) const { std::free(p); }
    };

    std::size_t index(Site s) const {
        auto const x = static_cast<std::size_t>(s.x + half_);
        auto const y = static_cast<std::size_t>(s.y + half_);
        return ((y / tile) * across_ + x / tile) * sites + (y % tile) * tile + x % tile;
    }

    std::int32_t half_;
    std::size_t across_;
    std::unique_ptr<std::uint8_t[], Free> bytes_;
};

} // namespace thalweg::network
