// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/dla/internal/walk.hpp>

#include <algorithm>
#include <array>
#include <cstring>

namespace thalweg::network {

namespace {

constexpr std::int32_t first_half = 64;

/// Row |dy| of the closeness around an occupied site, by dx + 32.
using Profile = std::array<std::array<std::uint8_t, 64>, 16>;

constexpr Profile make_profile() {
    Profile profile{};
    for (std::size_t dy = 0; dy < 16; ++dy) {
        for (std::size_t place = 32 - 15; place <= 32 + 15; ++place) {
            std::size_t const distance = std::max(place < 32 ? 32 - place : place - 32, dy);
            profile[dy][place] = static_cast<std::uint8_t>(16 - distance);
        }
    }
    return profile;
}

constexpr Profile profile = make_profile();

/// Sixteen bytes at once: the copies tell the compiler that the rows do not overlap.
void raise(std::uint8_t* row, std::uint8_t const* to) {
    std::array<std::uint8_t, 16> a;
    std::array<std::uint8_t, 16> b;
    std::memcpy(a.data(), row, 16);
    std::memcpy(b.data(), to, 16);
    for (std::size_t i = 0; i < 16; ++i) {
        a[i] = a[i] < b[i] ? b[i] : a[i];
    }
    std::memcpy(row, a.data(), 16);
}

/// Blocks of this side across the square that reaches twice `half` from the seed.
std::size_t blocks_across(std::int32_t half, std::size_t side) {
    return (4 * static_cast<std::size_t>(half) + side - 1) / side;
}

} // namespace

void FreeSquares::Blocks::occupy(std::size_t col, std::size_t row) {
    std::size_t const west = col < 15 ? 0 : col - 15;
    std::size_t const east = std::min(col + 15, across - 1);
    std::size_t const north = row < 15 ? 0 : row - 15;
    std::size_t const south = std::min(row + 15, across - 1);
    for (std::size_t r = north; r <= south; ++r) {
        auto const& line = profile[r < row ? row - r : r - row];
        for (std::size_t c = west; c <= east; ++c) {
            std::uint8_t& value = closeness[r * across + c];
            value = std::max(value, line[c + 32 - col]);
        }
    }
}

FreeSquares::FreeSquares()
    : near_(first_half), blocks_(blocks_across(first_half, 16)), great_blocks_(blocks_across(first_half, 256)) {}

void FreeSquares::occupy_block(std::size_t col, std::size_t row) {
    if (blocks_.at(col, row) == at_hand) {
        return;
    }
    blocks_.occupy(col, row);
    if (great_blocks_.at(col / 16, row / 16) != at_hand) {
        great_blocks_.occupy(col / 16, row / 16);
    }
}

void FreeSquares::occupy(Site site) {
    auto const x = static_cast<std::size_t>(site.x + half());
    auto const y = static_cast<std::size_t>(site.y + half());
    for (std::size_t tile_row = (y - 15) / 16; tile_row <= (y + 15) / 16; ++tile_row) {
        std::size_t const top = std::max(16 * tile_row, y - 15);
        std::size_t const bottom = std::min(16 * tile_row + 15, y + 15);
        for (std::size_t tile_col = (x - 15) / 16; tile_col <= (x + 15) / 16; ++tile_col) {
            std::uint8_t* const tile = near_.tile_at(tile_col, tile_row);
            std::size_t const from = 16 * tile_col + 32 - x;
            for (std::size_t r = top; r <= bottom; ++r) {
                raise(tile + 16 * (r % 16), profile[r < y ? y - r : r - y].data() + from);
            }
        }
    }
    auto const beside = static_cast<std::size_t>(half() / 16);
    occupy_block(x / 16 + beside, y / 16 + beside);
}

void FreeSquares::reach(std::int32_t radius) {
    std::int32_t wanted = half();
    // The finest level is asked up to two blocks from an occupied one.
    while (wanted < radius + 48) {
        wanted *= 2;
    }
    if (wanted == half()) {
        return;
    }
    auto const shift = static_cast<std::size_t>(2 * (wanted - half()) / 16);
    Blocks const before = std::move(blocks_);
    near_.widen(wanted);
    blocks_ = Blocks(blocks_across(wanted, 16));
    great_blocks_ = Blocks(blocks_across(wanted, 256));
    for (std::size_t row = 0; row < before.across; ++row) {
        for (std::size_t col = 0; col < before.across; ++col) {
            if (before.at(col, row) == at_hand) {
                occupy_block(col + shift, row + shift);
            }
        }
    }
}

} // namespace thalweg::network
