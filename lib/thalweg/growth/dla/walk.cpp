// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/dla/internal/walk.hpp>

#include <cmath>
#include <cstring>
#include <numeric>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::growth {
namespace {

struct Direction {
    double x;
    double y;
};

Direction uniform_direction(RandomStream& random) {
    for (;;) {
        std::uint64_t const word = random.word();
        // Half a step off the integers makes the four quadrants symmetric and avoids the origin.
        double const u = (static_cast<double>(static_cast<std::uint32_t>(word)) + 0.5) * 0x1p-31 - 1.0;
        double const v = (static_cast<double>(word >> 32) + 0.5) * 0x1p-31 - 1.0;
        double const square = u * u + v * v;
        if (square <= 1.0) {
            return {(u * u - v * v) / square, 2.0 * u * v / square};
        }
    }
}

Site nearest_site(double x, double y) {
    return {static_cast<std::int32_t>(std::floor(x + 0.5)), static_cast<std::int32_t>(std::floor(y + 0.5))};
}

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

/// Sixteen bytes at a time: the copies tell the compiler that the rows do not overlap.
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

/// Number of blocks of this side across the square that extends to twice `half` from the seed.
std::size_t blocks_across(std::int32_t half, std::size_t side) {
    return (4 * static_cast<std::size_t>(half) + side - 1) / side;
}

constexpr std::uint64_t growth_stage = 1;

} // namespace

LaunchCircle launch_circle(double cluster_radius) {
    LaunchCircle circle;
    circle.radius = cluster_radius + 4.0;
    circle.far = static_cast<std::int32_t>(std::max(1.5 * circle.radius, circle.radius + 24.0));
    return circle;
}

Site launch_site(LaunchCircle const& circle, RandomStream& random) {
    Direction const w = uniform_direction(random);
    return nearest_site(circle.radius * w.x, circle.radius * w.y);
}

Site back_from_afar(LaunchCircle const& circle, Site from, RandomStream& random) {
    Direction const w = uniform_direction(random);
    double const scale = circle.radius / static_cast<double>(squared(from));
    double const ax = scale * from.x;
    double const ay = scale * from.y;
    double const top_x = w.x + ax;
    double const top_y = w.y + ay;
    double const low_x = 1.0 + ax * w.x + ay * w.y;
    double const low_y = ax * w.y - ay * w.x;
    double const length = circle.radius / (low_x * low_x + low_y * low_y);
    return nearest_site(length * (top_x * low_x + top_y * low_y), length * (top_y * low_x - top_x * low_y));
}

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

Stamp::Stamp(std::vector<Site> sites) : sites_(std::move(sites)) {
    for (Site const s : sites_) {
        reach_ = std::max(reach_, chebyshev(s) + 15);
    }
    closeness_.resize(static_cast<std::size_t>((2 * reach_ + 1) * stride()), 0);
    for (Site const s : sites_) {
        for (std::int32_t y = -15; y <= 15; ++y) {
            for (std::int32_t x = -15; x <= 15; ++x) {
                std::uint8_t& value =
                    closeness_[static_cast<std::size_t>((s.y + y + reach_) * stride() + s.x + x + reach_ + 16)];
                value = std::max(value, static_cast<std::uint8_t>(16 - chebyshev({x, y})));
            }
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

void FreeSquares::occupy(Site middle, Stamp const& stamp) {
    auto const x = static_cast<std::size_t>(middle.x + half());
    auto const y = static_cast<std::size_t>(middle.y + half());
    auto const reach = static_cast<std::size_t>(stamp.reach());
    for (std::size_t tile_row = (y - reach) / 16; tile_row <= (y + reach) / 16; ++tile_row) {
        std::size_t const top = std::max(16 * tile_row, y - reach);
        std::size_t const bottom = std::min(16 * tile_row + 15, y + reach);
        for (std::size_t tile_col = (x - reach) / 16; tile_col <= (x + reach) / 16; ++tile_col) {
            std::uint8_t* const tile = near_.tile_at(tile_col, tile_row);
            std::size_t const from = 16 * tile_col + reach + 16 - x;
            for (std::size_t r = top; r <= bottom; ++r) {
                auto const dy = static_cast<std::int32_t>(r) - static_cast<std::int32_t>(y);
                raise(tile + 16 * (r % 16), stamp.row(dy) + from);
            }
        }
    }
    for (Site const o : stamp.sites()) {
        occupy_block(static_cast<std::size_t>(middle.x + o.x + 2 * half()) / 16,
                     static_cast<std::size_t>(middle.y + o.y + 2 * half()) / 16);
    }
}

void FreeSquares::occupy(Site site) {
    static Stamp const single({{0, 0}});
    occupy(site, single);
}

void FreeSquares::reach(std::int32_t radius) {
    // The finest level is read up to two blocks from an occupied one.
    if (radius + 48 <= half()) {
        return;
    }
    // By a multiple of 128 the blocks of 256 sites stay where they are.
    std::int32_t const wanted = (std::max(radius + 48, half() + half() / 4) + 127) / 128 * 128;
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

std::vector<double> exit_probabilities(int half) {
    double const side = 2.0 * half;
    std::vector<double> p(static_cast<std::size_t>(half), 0.0);
    for (int k = 1; k < 2 * half; k += 2) {
        double const angle = portable::pi * k / side;
        double const s = portable::sin(0.5 * angle);
        double const decay = side * portable::log(s + std::sqrt(1.0 + s * s));
        if (decay > 45.0) {
            break;
        }
        double const weight = 2.0 / (side * (portable::exp(decay) + portable::exp(-decay)));
        for (std::size_t j = 0; j < p.size(); ++j) {
            p[j] += weight * portable::cos(angle * static_cast<double>(j));
        }
    }
    return p;
}

ExitLaw::Table ExitLaw::make_table(int half) {
    std::vector<double> share = exit_probabilities(half);
    std::size_t const count = share.size();
    // An offset and its mirror image share an entry; the sign of 0 does not matter.
    for (std::size_t j = 0; j < count; ++j) {
        share[j] = std::max(share[j], 0.0) * (j == 0 ? 1.0 : 2.0);
    }
    double const mean = std::accumulate(share.begin(), share.end(), 0.0) / static_cast<double>(count);
    std::vector<std::size_t> poor;
    std::vector<std::size_t> rich;
    for (std::size_t j = 0; j < count; ++j) {
        share[j] /= mean;
        (share[j] < 1.0 ? poor : rich).push_back(j);
    }
    Table table;
    table.half = count;
    table.entries.resize(count);
    auto const set = [&](std::size_t j, double keeps, std::size_t alias) {
        auto const bits = static_cast<std::uint64_t>(keeps * 0x1p52);
        table.entries[j] = std::min(bits, low_52_bits) << 12 | alias;
    };
    while (!poor.empty() && !rich.empty()) {
        std::size_t const from = rich.back();
        std::size_t const to = poor.back();
        poor.pop_back();
        set(to, share[to], from);
        share[from] -= 1.0 - share[to];
        if (share[from] < 1.0) {
            rich.pop_back();
            poor.push_back(from);
        }
    }
    for (auto const* rest : {&poor, &rich}) {
        for (std::size_t const j : *rest) {
            set(j, 1.0, j);
        }
    }
    return table;
}

void ExitLaw::prepare(int longest) {
    for (int half = longest_ + 1; half <= std::min(longest, 15 * 256); ++half) {
        if (tables_[slot(half)].half == 0) {
            tables_[slot(half)] = make_table(half);
        }
    }
    longest_ = std::max(longest_, longest);
}

Walker walker(std::uint64_t seed, std::int64_t number) {
    return {{}, RandomStream(seed, growth_stage, static_cast<std::uint64_t>(number))};
}

void Walk::occupy(Site site) {
    double const distance = std::sqrt(static_cast<double>(squared(site)));
    if (distance > radius_ || circle_.far == 0) {
        radius_ = distance;
        circle_ = launch_circle(distance);
        squares_.reach(static_cast<std::int32_t>(distance) + 1);
        law_.prepare(circle_.far);
    }
    squares_.occupy(site);
}

unsigned Walk::occupied_neighbours(Site site) const {
    unsigned mask = 0;
    for (unsigned d = 0; d < 4; ++d) {
        mask |= static_cast<unsigned>(occupied(neighbour(site, d))) << d;
    }
    return mask;
}

unsigned Walk::approach(Walker& walker) const {
    for (;;) {
        std::int32_t const room = circle_.far - chebyshev(walker.at);
        if (room <= 0) {
            walker.at = back_from_afar(circle_, walker.at, walker.random);
            continue;
        }
        std::int32_t const free = squares_.free_half(walker.at);
        if (free == 0) {
            unsigned const mask = occupied_neighbours(walker.at);
            if (mask != 0) {
                return mask;
            }
        }
        // A wider square would skip the first site at the far limit.
        ExitLaw::Offset const jump = law_.leave(std::max(std::min(free, room), 1), walker.random);
        walker.at = {walker.at.x + jump.x, walker.at.y + jump.y};
    }
}

void Walk::step(Walker& walker) const {
    for (;;) {
        Site const next = neighbour(walker.at, static_cast<unsigned>(walker.random.word() >> 62));
        if (!occupied(next)) {
            walker.at = next;
            return;
        }
    }
}

std::vector<Cell> first_arrivals(std::span<Cell const> cluster, std::int64_t walkers, std::uint64_t seed,
                                 Run const& run) {
    refuse_if<BadInput>(cluster.empty(), "growth.first_arrivals", "the cluster has no cell, give at least one");
    constexpr std::int64_t widest = 1 << 20;
    for (Cell const c : cluster) {
        refuse_if<BadInput>(std::abs(c.col) > widest || std::abs(c.row) > widest, "growth.first_arrivals",
                            "cell ({}, {}) lies more than {} cells from the centre", c.col, c.row, widest);
    }
    Walk walk;
    for (Cell const c : cluster) {
        walk.occupy({static_cast<std::int32_t>(c.col), static_cast<std::int32_t>(c.row)});
    }
    std::vector<Cell> hits;
    hits.reserve(static_cast<std::size_t>(walkers));
    for (std::int64_t i = 0; i < walkers; ++i) {
        if (i % 4096 == 0) {
            run.check();
        }
        Walker w = walker(seed, i);
        walk.release(w);
        walk.approach(w);
        hits.push_back({w.at.x, w.at.y});
    }
    return hits;
}

} // namespace thalweg::growth
