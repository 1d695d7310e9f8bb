// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/channels.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

/// Rivers at random, for whatever is drawn around them.
namespace channel_trees {

using namespace thalweg;

inline std::vector<std::int64_t> beside(Grid const& grid, std::int64_t cell) {
    std::vector<std::int64_t> out;
    Cell const at = grid.at(cell);
    for (Cell const step : d8_steps) {
        if (Cell const n{at.col + step.col, at.row + step.row}; grid.contains(n)) {
            out.push_back(grid.index(n));
        }
    }
    return out;
}

/// How closely rivers may lie together.
enum class Room {
    apart, ///< a cell touches its receiver and its donors only
    crowd  ///< any cell may be taken
};

/// Grows trees from their ends at random until they have so many cells, or no room is left.
inline Channels grown(Grid const& grid, std::vector<std::int64_t> const& ends, Mask const& land, std::int64_t cells,
                      Room room, std::uint64_t seed) {
    Channels rivers{grid, {}, {}, {}, {}};
    std::vector<std::int64_t> number(static_cast<std::size_t>(grid.cells()), -1);
    auto const number_of = [&](std::int64_t cell) -> std::int64_t& { return number[static_cast<std::size_t>(cell)]; };
    auto const neighbours = [&](std::int64_t cell) {
        auto const near = beside(grid, cell);
        return std::count_if(near.begin(), near.end(), [&](std::int64_t n) { return number_of(n) >= 0; });
    };
    auto const put = [&](std::int64_t cell, std::int64_t receiver) {
        number_of(cell) = static_cast<std::int64_t>(rivers.cell.size());
        rivers.cell.push_back(cell);
        rivers.receiver.push_back(receiver);
    };
    for (std::int64_t const end : ends) {
        if (number_of(end) < 0 && (room == Room::crowd || neighbours(end) == 0)) {
            put(end, -1);
        }
    }
    for (std::uint64_t draw = 0; draw < 40 * static_cast<std::uint64_t>(cells); ++draw) {
        if (static_cast<std::int64_t>(rivers.cell.size()) >= cells) {
            break;
        }
        auto const from = random_word(seed, 11, draw) % rivers.cell.size();
        auto const near = beside(grid, rivers.cell[from]);
        if (near.empty()) {
            break;
        }
        std::int64_t const to = near[random_word(seed, 12, draw) % near.size()];
        bool const dry = land.cells() == 0 || land[to] != 0;
        if (dry && number_of(to) < 0 && (room == Room::crowd || neighbours(to) == 1)) {
            put(to, static_cast<std::int64_t>(from));
        }
    }
    return rivers;
}

/// Rivers straight through the grid, southwards.
inline Channels parallel(Grid const& grid, std::vector<std::int64_t> const& columns) {
    Channels rivers;
    rivers.grid = grid;
    for (std::int64_t const col : columns) {
        for (std::int64_t row = grid.height - 1; row >= 0; --row) {
            bool const ends = row == grid.height - 1;
            rivers.receiver.push_back(ends ? -1 : static_cast<std::int64_t>(rivers.cell.size()) - 1);
            rivers.cell.push_back(grid.index({col, row}));
        }
    }
    return rivers;
}

/// Heights and ridges at random, up to one in eight cells.
inline std::vector<surface::FeatureCell> any_features(Grid const& grid, std::uint64_t seed) {
    std::vector<surface::FeatureCell> out;
    std::uint64_t const rare = 8 + random_word(seed, 61, 0) % 200;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        std::uint64_t const word = random_word(seed, 62, static_cast<std::uint64_t>(i));
        bool const crest = grid.at(i).col == grid.width / 3;
        if (crest || word % rare == 0) {
            float const z = word / rare % 3 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                                 : static_cast<float>(word / rare % 1000) - 300.0F;
            out.push_back({i, z, crest});
        }
    }
    return out;
}

} // namespace channel_trees
