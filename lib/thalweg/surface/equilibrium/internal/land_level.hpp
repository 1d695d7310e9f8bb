// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/run/large_pages.hpp>
#include <thalweg/surface/equilibrium/internal/river_cells.hpp>

/// Private to this module.
namespace thalweg::surface {

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
    Cells<std::uint8_t> shift;  ///< where in its cell a node lies: code of jitter.hpp
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

} // namespace thalweg::surface
