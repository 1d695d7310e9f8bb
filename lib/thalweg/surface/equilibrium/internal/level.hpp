// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/memory.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

namespace thalweg::surface {

/// factor area ^ exponent from a table: exact for whole numbers below 512, beyond for areas rounded down to nine binary
/// digits. bend_area: area below which the power hardly falls any more, to that of the bend; 0: none.
class AreaPower {
public:
    explicit AreaPower(double exponent, double bend_area = 0.0, double factor = 1.0) {
        double const least = bend_area > 0.0 ? portable::pow(bend_area, sharpness * exponent) : 0.0;
        for (std::size_t i = 0; i < table_.size(); ++i) {
            auto const bits = static_cast<std::uint32_t>((i + first) << dropped);
            auto const area = static_cast<double>(std::bit_cast<float>(bits));
            table_[i] = static_cast<float>(
                factor * (least > 0.0
                              ? portable::pow(portable::pow(area, sharpness * exponent) + least, 1.0 / sharpness)
                              : portable::pow(area, exponent)));
        }
    }

    /// Takes: 1 <= area < 2^64.
    float operator()(float area) const { return table_[(std::bit_cast<std::uint32_t>(area) >> dropped) - first]; }

private:
    static constexpr double sharpness = 2.0; // of the bend
    static constexpr std::uint32_t dropped = 15;
    static constexpr std::size_t first = std::size_t{127} << 8;
    std::vector<float> table_ = std::vector<float>(std::size_t{64} << 8);
};

/// U + D lap z = K A^theta S in the solver's units: lengths, heights and areas in cells of the finest level, U 1 where
/// nothing is said, and K such that slopes where hardly anything drains are the same at any cell size: far from what
/// floats can lose.
struct EquilibriumLaw {
    EquilibriumLaw(EquilibriumParams const& params, double cell_m)
        : EquilibriumLaw(params, cell_m, incision(params, cell_m)) {}

    AreaPower power;      ///< K A^theta, of the given rivers
    AreaPower land_power; ///< of the land: below the area of debris flows these cut as well, and slopes hardly change
                          ///< with it any more (Stock and Dietrich 2003)
    float creep;          ///< D, by the length below which creep wins (Perron 2009)
    float source_area;    ///< [finest cells] that a drawn source drains already

private:
    EquilibriumLaw(EquilibriumParams const& params, double cell_m, double k)
        : power(params.theta, 0.0, k), land_power(params.theta, debris_cells(params, cell_m), k),
          creep(static_cast<float>(
              k * portable::pow(std::min(params.hillslope_m / cell_m, most_creep), 2.0 * params.theta + 1.0))),
          source_area(static_cast<float>(source_area_m2 / (cell_m * cell_m))) {}

    static double debris_cells(EquilibriumParams const& params, double cell_m) {
        return params.debris_area_m2 / (cell_m * cell_m);
    }
    static double incision(EquilibriumParams const& params, double cell_m) {
        constexpr double of_one_cell = 4.7; // times less than uplift: slopes of heads are a good half of the cap
        return of_one_cell / static_cast<double>(AreaPower(params.theta, debris_cells(params, cell_m))(1.0F));
    }

    static constexpr double most_creep = 100.0; // [finest cells]: beyond, rounds do not suffice
    static constexpr double source_area_m2 = 90'000.0;
};

/// The direction from a cell to its neighbour, as d8_steps, or -1 when it is none. Takes: cells inside a frame.
inline std::int8_t way_between(std::size_t from, std::size_t to, std::int64_t width) {
    std::int64_t const step = static_cast<std::int64_t>(to) - static_cast<std::int64_t>(from);
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        if (d8_steps[k].row * width + d8_steps[k].col == step) {
            return static_cast<std::int8_t>(k);
        }
    }
    return -1;
}

/// Channels in the frame of a level, downstream first. The vectors are parallel.
struct RiverCells {
    std::vector<std::uint32_t> cell;    ///< index in the level
    std::vector<std::int32_t> receiver; ///< number in these lists, -1 for none
    std::vector<std::int8_t> way;       ///< to the receiver, as d8_steps
    std::vector<std::uint8_t> level;    ///< 1: as high as its receiver
    std::vector<float> asked;           ///< height, NaN for none; empty: none at all
    std::vector<std::int64_t> number;   ///< in the caller's Channels, -1: beyond its grid
};

/// The rivers on a grid of half as many cells a side: a coarse cell takes over the river cell in it that has the
/// fewest steps to its end (ties: the first), so that rivers stay trees. Widths are those of framed levels.
RiverCells coarsened(RiverCells const& fine, std::int64_t fine_width, std::int64_t coarse_width,
                     std::int64_t coarse_height);

template <class T> using Cells = std::vector<T, LargePages<T>>;

/// What a cell is to the solver.
enum class Cover : std::uint8_t {
    land,
    rim,      ///< land beside outside: creep goes to fewer neighbours
    bank,     ///< land beside a river, at the finest level
    rim_bank, ///< both
    river,
    edge,   ///< water leaves, at a height that is set
    sea,    ///< water leaves, at 0
    outside ///< nothing is there: infinitely high
};

inline bool is_land(Cover c) {
    return c <= Cover::rim_bank;
}
inline bool is_bank(Cover c) {
    return c == Cover::bank || c == Cover::rim_bank;
}

inline constexpr std::int8_t no_way = -1;

/// Lengths of the D8 steps [cells].
inline constexpr std::array<float, 8> step_lengths = {1.0F, 1.41421356F, 1.0F, 1.41421356F,
                                                      1.0F, 1.41421356F, 1.0F, 1.41421356F};

/// The least tangent of a cell towards its receiver: far above what a float can lose, far below what is seen.
inline constexpr float least_tangent = 0.002F;
/// The steepest slope that uplift keeps up in rock of the common erodibility.
inline constexpr float steepest_tangent = 0.3F;
inline constexpr float bank_step = least_tangent;

/// Water that enters a level.
struct Inflow {
    std::uint32_t cell;
    std::uint32_t area; ///< [cells of the level] that it drains
};

/// One level of the grid, in a frame one cell wide, so that every inner cell has eight neighbours. Lengths and heights
/// are in cells of the finest level.
struct LandLevel {
    std::int64_t width = 0;  ///< with the frame
    std::int64_t height = 0; ///< with the frame
    float side = 1.0F;       ///< of a cell
    Cell corner;             ///< [finest cells] where the first inner cell begins, from the caller's grid
    RiverCells rivers;
    Cells<Cover> cover;
    Cells<float> z;
    Cells<float> erodibility;
    Cells<float> cap;           ///< greatest tangent towards the receiver
    Cells<float> uplift;        ///< empty: 1 everywhere
    Cells<std::int8_t> way;     ///< to the receiver, as d8_steps, or no_way
    Cells<std::uint8_t> shift;  ///< where in its cell a node lies: code of jitter()
    Cells<std::uint32_t> area;  ///< [cells of this level]
    Cells<std::uint32_t> order; ///< land cells, receivers last
    std::vector<Inflow> inflow; ///< water from beyond the frame
    Cells<float> firmness;      ///< [log] by how much rock is firmer than the fields say; empty: nowhere

    std::int64_t cells() const { return width * height; }
    Cell at(std::size_t i) const {
        return {static_cast<std::int64_t>(i) % width, static_cast<std::int64_t>(i) / width};
    }
    std::array<std::int64_t, 8> offsets() const {
        std::array<std::int64_t, 8> out{};
        for (std::size_t k = 0; k < out.size(); ++k) {
            out[k] = d8_steps[k].row * width + d8_steps[k].col;
        }
        return out;
    }
};

/// Where a level's cell lies among those of a coarser one, counted from the centres of its cells.
struct LevelPlace {
    double col;
    double row;
};
inline LevelPlace place_in(LandLevel const& coarse, LandLevel const& level, std::int64_t col, std::int64_t row) {
    double const side = static_cast<double>(level.side);
    double const east =
        static_cast<double>(level.corner.col - coarse.corner.col) + (static_cast<double>(col) - 0.5) * side;
    double const south =
        static_cast<double>(level.corner.row - coarse.corner.row) + (static_cast<double>(row) - 0.5) * side;
    return {east / static_cast<double>(coarse.side) + 0.5, south / static_cast<double>(coarse.side) + 0.5};
}

/// The value there of a field on the level's cells, between those inside its frame.
inline float value_at(LandLevel const& level, Cells<float> const& field, LevelPlace p) {
    double const left = std::floor(p.col);
    double const top = std::floor(p.row);
    auto const value = [&](double col, double row) {
        auto const c = std::clamp<std::int64_t>(static_cast<std::int64_t>(col), 1, level.width - 2);
        auto const r = std::clamp<std::int64_t>(static_cast<std::int64_t>(row), 1, level.height - 2);
        return field[static_cast<std::size_t>(r * level.width + c)];
    };
    auto const u = static_cast<float>(p.col - left);
    auto const v = static_cast<float>(p.row - top);
    float const upper = value(left, top) + (value(left + 1.0, top) - value(left, top)) * u;
    float const lower = value(left, top + 1.0) + (value(left + 1.0, top + 1.0) - value(left, top + 1.0)) * u;
    return upper + (lower - upper) * v;
}

/// Calls visit(cell) for the cells inside the frame, row by row.
template <class Visit> void each_inner(LandLevel const& level, Visit visit) {
    for (std::int64_t row = 1; row + 1 < level.height; ++row) {
        for (std::int64_t i = row * level.width + 1; i + 1 < (row + 1) * level.width; ++i) {
            visit(static_cast<std::size_t>(i));
        }
    }
}

inline std::size_t moved(std::size_t cell, std::int64_t offset) {
    return static_cast<std::size_t>(static_cast<std::int64_t>(cell) + offset);
}

/// Calls visit(cell) for the sixteen cells two columns or rows away from one, unless it is too near the frame.
template <class Visit> void each_of_second_ring(LandLevel const& level, std::uint32_t cell, Visit visit) {
    std::int64_t const col = cell % level.width;
    std::int64_t const row = cell / level.width;
    if (col < 2 || row < 2 || col + 2 >= level.width || row + 2 >= level.height) {
        return;
    }
    for (std::int64_t d = -2; d <= 2; ++d) {
        visit(moved(cell, -2 * level.width + d));
        visit(moved(cell, 2 * level.width + d));
        if (d != -2 && d != 2) {
            visit(moved(cell, d * level.width - 2));
            visit(moved(cell, d * level.width + 2));
        }
    }
}

/// Height of the highest river cell beside an inner cell, minus infinity without one.
inline float highest_river(LandLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    float highest = -std::numeric_limits<float>::infinity();
    for (std::int64_t const offset : offsets) {
        if (std::size_t const n = moved(i, offset); level.cover[n] == Cover::river) {
            highest = std::max(highest, level.z[n]);
        }
    }
    return highest;
}

struct NearestRiver {
    static constexpr std::uint32_t none = 0xffffffff;
    Cells<float> distance;       ///< [cells of the level] less the head start of the river cell
    Cells<std::uint32_t> number; ///< of the river cell in the level's rivers
};

/// The river cell nearest to each inner cell, by steps of 1 and sqrt(2) in two passes, where each river cell begins
/// with a head start (by number; empty: none). The frame has none. Memory: what the numbers are kept in.
NearestRiver nearest_river(LandLevel const& level, std::vector<float> const& head_start = {},
                           Cells<std::uint32_t> memory = {});

} // namespace thalweg::surface
