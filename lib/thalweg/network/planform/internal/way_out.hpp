// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/planform/internal/carry_ground.hpp>

namespace thalweg::network {

/// Where rivers may end: on the grid's border and beside the sea.
class RiverEnds {
public:
    explicit RiverEnds(Grid grid) : grid_(std::move(grid)) {}
    explicit RiverEnds(Mask const& land);

    /// King's moves to the nearest end.
    std::int64_t steps(Cell c) const;
    bool is_land(Cell c) const { return !grid_.contains(c) || land_.cells() == 0 || land_[c] != 0; }
    bool at_border(Cell c) const { return grid_.on_border(c); }

private:
    static constexpr std::int32_t unreached = -1;
    Grid grid_;
    Mask land_;
    Raster<std::int32_t> steps_;
};

/// A way of cells, the river's own first; empty where there is none.
struct Way {
    std::vector<Cell> cells;
    Confluence const* into = nullptr; ///< in the last cell; null: it ends where rivers may end
};

/// The cheapest way from a river's end, in the cell start, to where rivers may end, or into a river that it may join.
/// Of equally cheap ways the one that goes straight on. Source: A*, Hart, Nilsson and Raphael 1968: each step costs at
/// least one and comes at most one cell nearer; what is joined counts as the end.
Way way_out(Vec2 outlet, Cell start, CarryGround const& ground, RiverEnds const& ends,
            std::function<bool(Confluence const&)> const& may_join);

} // namespace thalweg::network
