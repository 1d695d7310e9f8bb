// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <utility>

#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/channels.hpp>

/// Laws of channels.
namespace test {

using namespace thalweg;

inline Cell channel_cell(Channels const& rivers, std::int64_t number) {
    return rivers.grid.at(rivers.cell[static_cast<std::size_t>(number)]);
}

inline bool are_neighbours(Cell a, Cell b) {
    return !(a == b) && std::abs(a.col - b.col) <= 1 && std::abs(a.row - b.row) <= 1;
}

/// Random rivers and a grid that holds them.
struct SomeRivers {
    std::uint64_t seed = 0;
    bool on_lattice = false; ///< from cell to cell, as grown; else lines that may cross
    StreamNetwork net;
    Grid grid; ///< 40 x 40
};

inline SomeRivers some_rivers() {
    SomeRivers some{*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::arbitrary<bool>(), {}, frame(40, 40)};
    some.net = some.on_lattice ? random_skeleton(some.seed, 40)
                               : random_forest(some.seed, *rc::gen::inRange<std::size_t>(0, 20), 2);
    some.grid.cell_m = some.on_lattice ? 1.0 : 25.0;
    some.grid.north = 40.0 * some.grid.cell_m;
    return some;
}

enum class Diagonals { may_cross, do_not_cross };

/// The law of core/channels.hpp, and that no two diagonal steps cross.
inline void require_law(Channels const& rivers, Diagonals diagonals = Diagonals::do_not_cross) {
    RC_ASSERT(rivers.receiver.size() == rivers.cell.size());
    std::set<std::int64_t> once;
    std::set<std::pair<std::int64_t, std::int64_t>> steps;
    for (std::size_t i = 0; i < rivers.cell.size(); ++i) {
        RC_ASSERT(rivers.cell[i] >= 0);
        RC_ASSERT(rivers.cell[i] < rivers.grid.cells());
        RC_ASSERT(once.insert(rivers.cell[i]).second);
        RC_ASSERT(rivers.receiver[i] >= -1);
        RC_ASSERT(rivers.receiver[i] < static_cast<std::int64_t>(i));
        if (rivers.receiver[i] >= 0) {
            Cell const here = rivers.grid.at(rivers.cell[i]);
            Cell const there = channel_cell(rivers, rivers.receiver[i]);
            RC_ASSERT(are_neighbours(here, there));
            steps.insert(std::minmax(rivers.grid.index(here), rivers.grid.index(there)));
        }
    }
    if (diagonals == Diagonals::may_cross) {
        return;
    }
    for (auto const& [a, b] : steps) {
        Cell const p = rivers.grid.at(a);
        Cell const q = rivers.grid.at(b);
        if (p.col != q.col && p.row != q.row) {
            RC_ASSERT(
                !steps.contains(std::minmax(rivers.grid.index({p.col, q.row}), rivers.grid.index({q.col, p.row}))));
        }
    }
}

/// No cell has a neighbour among the next cells downstream but the first, unless a diagonal lies between.
inline void require_short(Channels const& rivers, std::int64_t look_cells) {
    std::set<std::pair<std::int64_t, std::int64_t>> steps;
    for (std::size_t i = 0; i < rivers.cell.size(); ++i) {
        if (rivers.receiver[i] >= 0) {
            steps.insert(std::minmax(rivers.cell[i], rivers.cell[static_cast<std::size_t>(rivers.receiver[i])]));
        }
    }
    for (std::size_t i = 0; i < rivers.cell.size(); ++i) {
        std::int64_t ahead = rivers.receiver[i];
        for (std::int64_t k = 2; k <= look_cells && ahead >= 0; ++k) {
            ahead = rivers.receiver[static_cast<std::size_t>(ahead)];
            if (ahead >= 0) {
                Cell const here = rivers.grid.at(rivers.cell[i]);
                Cell const there = channel_cell(rivers, ahead);
                RC_ASSERT(!are_neighbours(here, there) ||
                          steps.contains(std::minmax(rivers.grid.index({here.col, there.row}),
                                                     rivers.grid.index({there.col, here.row}))));
            }
        }
    }
}

} // namespace test
