// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/hypsometry.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::measure {

namespace {

constexpr std::int64_t cells_a_range = 1 << 20;
constexpr std::int64_t shares = 100;

/// Maps floats to unsigned numbers in the same order; both zeros are equal.
std::uint32_t rank_of(float z) {
    auto const bits = std::bit_cast<std::uint32_t>(z + 0.0F);
    constexpr std::uint32_t sign = 0x80000000U;
    return (bits & sign) != 0 ? ~bits : bits | sign;
}

float height_of(std::uint32_t rank) {
    constexpr std::uint32_t sign = 0x80000000U;
    return std::bit_cast<float>((rank & sign) != 0 ? rank & ~sign : ~rank);
}

/// A rank has three digits, read from the highest.
struct Digit {
    unsigned shift;
    unsigned bits;
    std::uint32_t of(std::uint32_t rank) const { return (rank >> shift) & ((1U << bits) - 1U); }
    std::size_t values() const { return std::size_t{1} << bits; }
};
constexpr std::array<Digit, 3> digits{{{21, 11}, {10, 11}, {0, 10}}};

/// The digits read so far of the wanted cells: maps each digit to the node for the next digit.
using Nodes = std::vector<std::uint32_t>;
constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

/// A cell wanted by its position from the top, among those with the same digits so far.
struct Sought {
    std::int64_t place = 0;
    std::size_t node = 0;
    std::uint32_t rank = 0; ///< its digits so far
};

/// Counts the cells of each node by their digit at this depth.
std::vector<std::int64_t> count(Raster<float> const& dem, std::vector<Nodes> const& above, std::size_t nodes,
                                std::size_t depth, Run const& run) {
    std::size_t const values = digits[depth].values();
    std::vector<std::int64_t> total(nodes * values, 0);
    std::mutex adding;
    parallel_ranges(run, dem.cells(), cells_a_range, [&](std::int64_t begin, std::int64_t end) {
        std::vector<std::int64_t> here(total.size(), 0);
        run.check();
        for (std::int64_t i = begin; i < end; ++i) {
            if (std::isnan(dem[i])) {
                continue;
            }
            std::uint32_t const rank = rank_of(dem[i]);
            std::uint32_t node = 0;
            for (std::size_t d = 0; d < depth && node != nobody; ++d) {
                node = above[d][node * digits[d].values() + digits[d].of(rank)];
            }
            if (node != nobody) {
                ++here[node * values + digits[depth].of(rank)];
            }
        }
        std::scoped_lock const lock(adding);
        std::transform(here.begin(), here.end(), total.begin(), total.begin(), std::plus<>());
    });
    return total;
}

/// The heights at these positions from the top.
std::vector<double> heights_at(std::vector<std::int64_t> const& places, Raster<float> const& dem, Run const& run) {
    std::vector<Sought> sought;
    for (std::int64_t const place : places) {
        sought.push_back({place, 0, 0});
    }
    std::vector<Nodes> above;
    std::size_t nodes = 1;
    for (std::size_t depth = 0; depth < digits.size(); ++depth) {
        std::size_t const values = digits[depth].values();
        std::vector<std::int64_t> const counts = count(dem, above, nodes, depth, run);
        Nodes next(counts.size(), nobody);
        std::size_t further = 0;
        for (Sought& s : sought) {
            std::size_t at = (s.node + 1) * values - 1;
            for (; s.place >= counts[at]; --at) {
                s.place -= counts[at];
            }
            if (next[at] == nobody) {
                next[at] = static_cast<std::uint32_t>(further++);
            }
            s.rank |= static_cast<std::uint32_t>(at - s.node * values) << digits[depth].shift;
            s.node = next[at];
        }
        above.push_back(std::move(next));
        nodes = further;
    }
    std::vector<double> heights;
    for (Sought const& s : sought) {
        heights.push_back(static_cast<double>(height_of(s.rank)));
    }
    return heights;
}

/// Number of cells with a height; throws if one is infinite or none has one.
std::int64_t cells_with_height(Raster<float> const& dem) {
    std::int64_t cells = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isinf(dem[i])) {
            Cell const c = dem.grid().at(i);
            throw BadInput("measure.hypsometry",
                           fmt::format("the height at column {}, row {} is infinite; mark cells without data as NaN",
                                       c.col, c.row));
        }
        cells += std::isnan(dem[i]) ? 0 : 1;
    }
    refuse_if<BadInput>(cells == 0, "measure.hypsometry",
                        "none of the {} cells of the DEM has a height; is the no-data value right?", dem.cells());
    return cells;
}

/// Mean height above the lowest, summed in row order.
double mean_above(double lowest, Raster<float> const& dem, std::int64_t cells, Run const& run) {
    std::vector<CompensatedSum> rows(dem.height());
    parallel_ranges(run, dem.height(), 64, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            for (float const z : dem.row(r)) {
                if (!std::isnan(z)) {
                    rows[r].add(static_cast<double>(z) - lowest);
                }
            }
        }
    });
    CompensatedSum sum;
    for (CompensatedSum const& row : rows) {
        sum.add(row.value());
    }
    return sum.value() / static_cast<double>(cells);
}

} // namespace

Hypsometry hypsometry(Raster<float> const& dem, Run const& run) {
    std::int64_t const cells = cells_with_height(dem);
    std::vector<std::int64_t> places;
    for (std::int64_t k = 0; k <= shares; ++k) {
        // The product of a large DEM's cells and 100 is far below 2^63.
        places.push_back(k * (cells - 1) / shares);
    }
    std::vector<double> const heights = heights_at(places, dem, run);
    Hypsometry result;
    for (std::size_t k = 0; k < heights.size(); ++k) {
        result.points.push_back({static_cast<double>(k) / static_cast<double>(shares), heights[k]});
    }
    double const lowest = heights.back();
    double const range = heights.front() - lowest;
    if (range > 0.0) {
        result.integral = std::clamp(mean_above(lowest, dem, cells, run) / range, 0.0, 1.0);
    }
    return result;
}

} // namespace thalweg::measure
