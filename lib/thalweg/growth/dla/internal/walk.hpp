// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::growth {

/// A lattice position relative to the seed of the cluster: x to the east, y to the south.
struct Site {
    std::int32_t x = 0;
    std::int32_t y = 0;
    friend bool operator==(Site const&, Site const&) = default;
};

/// Distance to the seed, squared.
inline std::int64_t squared(Site s) {
    return std::int64_t{s.x} * s.x + std::int64_t{s.y} * s.y;
}

/// Chebyshev distance to the seed.
inline std::int32_t chebyshev(Site s) {
    return std::max(std::abs(s.x), std::abs(s.y));
}

/// Where walkers start around a cluster, and where they are relocated. The outer limit is a square, so that the free
/// squares of walkers can share a side with it.
struct LaunchCircle {
    double radius = 0.0; ///< [cells] launch radius: radius of the cluster + 4
    /// [cells] the larger of 1.5 radius and radius + 24: walkers with max(|x|,|y|) = far are relocated
    std::int32_t far = 0;

    bool lost(Site s) const { return chebyshev(s) >= far; }
};

/// The circle around a cluster of this radius [cells].
LaunchCircle launch_circle(double cluster_radius);

/// A uniform site of the launch circle, rounded to the lattice.
Site launch_site(LaunchCircle const& circle, RandomStream& random);

/// Where a walk from `from`, outside, first hits the launch circle, rounded to the lattice. In the plane the hitting
/// law is the exterior Poisson kernel (exact for Brownian motion, on the lattice up to terms of order 1/gap^2); it is
/// drawn as the image of a uniform point w under the Moebius map (w + a) / (1 + conj(a) w), a = radius/conj(from).
Site back_from_afar(LaunchCircle const& circle, Site from, RandomStream& random);

/// One byte per site on a square around the seed, initially 0, stored in tiles of 16 x 16 sites so that vertical
/// neighbours share a page. Memory that the walk never reaches is never touched.
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

    /// Enlarges the square; its content stays in place.
    void widen(std::int32_t half) {
        TiledBytes wider(half);
        auto const shift = static_cast<std::size_t>((half - half_) / tile);
        for (std::size_t row = 0; row < across_; ++row) {
            for (std::size_t col = 0; col < across_; ++col) {
                std::uint8_t const* const from = tile_at(col, row);
                if (std::any_of(from, from + sites, [](std::uint8_t b) { return b != 0; })) {
                    std::copy_n(from, sites, wider.tile_at(col + shift, row + shift));
                }
            }
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

/// Sites that are occupied together, and the closeness that they give to those around them.
class Stamp {
public:
    /// \param sites around the stamp's middle, at least one
    explicit Stamp(std::vector<Site> sites);

    std::vector<Site> const& sites() const { return sites_; }
    std::int32_t reach() const { return reach_; } ///< the closeness is 0 farther from the middle, in rows and columns
    /// Closeness in a row, by x + reach() + 16; beyond the reach are 16 zeros on either side.
    /// \param y [-reach(), reach()]
    std::uint8_t const* row(std::int32_t y) const { return closeness_.data() + (y + reach_) * stride(); }

private:
    std::int32_t stride() const { return 2 * reach_ + 1 + 2 * 16; }

    std::vector<Site> sites_;
    std::int32_t reach_ = 0;
    std::vector<std::uint8_t> closeness_;
};

/// The size of the free square around a site: the Chebyshev distance to the nearest occupied site, capped at 16, and
/// the same on blocks of 16 x 16 and of 256 x 256 sites.
class FreeSquares {
public:
    FreeSquares();

    /// Allocates space for a cluster of this radius [cells] around the seed.
    void reach(std::int32_t radius);

    /// The cluster and its neighbours lie in the square -half <= x, y < half; free_half accepts sites of a square twice
    /// as wide.
    std::int32_t half() const { return near_.half(); }

    /// Occupies the sites of a stamp, which lie in the square.
    void occupy(Site middle, Stamp const& stamp);
    /// Occupies a site in the square.
    void occupy(Site site);

    bool occupied(Site site) const { return near_[site] == at_hand; }

    /// Largest known L for which every site of the square max(|dx|,|dy|) <= L is free; 0 beside and diagonally beside
    /// the cluster. The cluster may touch the boundary of the square, but is never inside.
    std::int32_t free_half(Site site) const {
        // The coarse levels fit the cache, so they are checked first; far from the cluster they suffice.
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

    static constexpr std::int32_t at_hand = 16; ///< closeness of an occupied site is 16 - distance, 0 from 16 on

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

/// Computes where a simple random walk of the lattice from the centre of the square max(|x|,|y|) <= L first meets its
/// boundary. By the reflection principle and separation of variables the site (L, j) has the probability
///     p(j) = 1/(2L) sum over odd k < 2L of cos(k pi j / 2L) / cosh(L a_k),   sinh(a_k / 2) = sin(k pi / 4L),
/// and so have its images on the other sides; the corners cannot be reached.
/// \param half [1, ...] L
/// \return p(j) for j = 0 ... L-1, with sum 1/4; terms below 1e-19 are left out
///
/// Source: McCrea and Whipple 1940, Proc. R. Soc. Edinburgh 60.
std::vector<double> exit_probabilities(int half);

/// The law above as alias tables (Walker 1977), for the half sides 1 ... 31, 32 ... 248 in steps of 8, 256 ... 960 in
/// steps of 64 and 1024 ... 3840 in steps of 256.
class ExitLaw {
public:
    struct Offset {
        std::int32_t x;
        std::int32_t y;
    };

    /// Builds the tables of all half sides up to this one.
    void prepare(int longest);

    /// Jumps out of the largest square that has a table and a half side of at most `free`; [1, ...].
    Offset leave(int free, RandomStream& random) const {
        Table const& table = tables_[slot(free < longest_ ? free : longest_)];
        std::uint64_t const word = random.word();
        std::uint64_t const spot = (word >> 12) * table.half;
        std::uint64_t const entry = table.entries[spot >> 52];
        std::uint64_t const along = (spot & low_52_bits) < entry >> 12 ? spot >> 52 : entry & low_12_bits;
        auto const shift = static_cast<std::int32_t>((word & 1) != 0 ? along : 0 - along);
        auto const side = static_cast<std::int32_t>((word & 2) != 0 ? table.half : 0 - table.half);
        return (word & 4) != 0 ? Offset{side, shift} : Offset{shift, side};
    }

    /// Half side of the square used by leave(free).
    int half_side(int free) const { return static_cast<int>(tables_[slot(free < longest_ ? free : longest_)].half); }

private:
    static constexpr std::uint64_t low_52_bits = (std::uint64_t{1} << 52) - 1;
    static constexpr std::uint64_t low_12_bits = (std::uint64_t{1} << 12) - 1;

    struct Table {
        std::uint64_t half = 0;
        std::vector<std::uint64_t> entries; ///< by |offset|: 52 bits of its probability, 12 bits of its alias
    };

    static std::size_t slot(int free) {
        auto const f = static_cast<std::size_t>(free);
        return f < 32 ? f : f < 256 ? 28 + f / 8 : f < 1024 ? 56 + f / 64 : 68 + (f < 4096 ? f / 256 : 15);
    }
    static Table make_table(int half);

    std::array<Table, 84> tables_; ///< by slot; slot 0 is unused
    int longest_ = 0;              ///< tables exist for every half side up to this
};

/// The four neighbours of a site: north, east, south, west.
inline constexpr Site neighbour_offsets[4] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};

inline Site neighbour(Site s, unsigned direction) {
    return {s.x + neighbour_offsets[direction].x, s.y + neighbour_offsets[direction].y};
}

/// A random walker with its own random stream.
struct Walker {
    Site at;
    RandomStream random;
};

/// The walker with this number, not yet launched.
Walker walker(std::uint64_t seed, std::int64_t number);

/// The simple random walk of the lattice around a cluster, without unit steps in empty space: a walker jumps to the
/// boundary of the largest known free square by that square's exit law. Law: the sites at which walkers arrive beside
/// the cluster are distributed as for a walk by unit steps from the same launch circles.
class Walk {
public:
    /// Occupies a site: the cluster grows.
    void occupy(Site site);

    double radius() const { return radius_; } ///< [cells] of the cluster
    bool occupied(Site site) const { return squares_.occupied(site); }
    std::int32_t half() const {
        return squares_.half();
    } ///< the cluster and its neighbours lie in -half <= x, y < half

    /// Places a walker on the launch circle.
    void release(Walker& walker) const { walker.at = launch_site(circle_, walker.random); }

    /// Walks until the walker is on a free site with an occupied neighbour; it may already be on one.
    /// \return the occupied neighbours, bit d for direction d
    unsigned approach(Walker& walker) const;

    /// One step to a free neighbour, all equally likely.
    void step(Walker& walker) const;

private:
    unsigned occupied_neighbours(Site site) const;

    FreeSquares squares_;
    ExitLaw law_;
    LaunchCircle circle_;
    double radius_ = 0.0;
};

/// Samples where walkers first arrive on a cluster that does not grow, to compare the hit distribution with that of
/// unit steps.
/// \param cluster occupied cells; (0,0) is the centre of the launch circle
/// \param walkers number of walkers
/// \param seed random seed
/// \return by walker: a free cell with an occupied 4-neighbour
/// \throws BadInput when no cell is occupied or one is more than 2^20 cells from the centre
std::vector<Cell> first_arrivals(std::span<Cell const> cluster, std::int64_t walkers, std::uint64_t seed,
                                 Run const& run = {});

} // namespace thalweg::growth
