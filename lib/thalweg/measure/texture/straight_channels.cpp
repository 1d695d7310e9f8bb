// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/texture/straight_channels.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/run/range.hpp>

namespace thalweg::measure {

namespace {

struct Channels {
    flow::FlowField const& drainage;
    StraightChannelsParams const& params;

    bool contains(std::int64_t cell) const {
        return drainage.area_cells[cell] >= params.support_cells && goes_on(drainage.direction[cell]);
    }
};

/// Whether the channel cell that flows here does so in the same direction.
bool run_goes_on_upstream(Channels const& channels, Cell at, flow::Direction direction) {
    Cell const step = d8_steps[index_of(direction)];
    Cell const above{at.col - step.col, at.row - step.row};
    Grid const& grid = channels.drainage.grid();
    return grid.contains(above) && channels.drainage.direction[above] == direction &&
           channels.contains(grid.index(above));
}

std::int64_t run_from(flow::FlowField const& drainage, std::int64_t cell) {
    flow::Direction const direction = drainage.direction[cell];
    std::int64_t steps = 0;
    for (std::int64_t at = cell; at >= 0 && drainage.direction[at] == direction; at = drainage.receiver(at)) {
        ++steps;
    }
    return steps;
}

/// The cells of a reach; fewer than steps + 1 where the water ends.
void walk(flow::FlowField const& drainage, std::int64_t cell, std::int64_t steps, std::vector<Cell>& reach) {
    reach.clear();
    for (std::int64_t at = cell; at >= 0; at = drainage.receiver(at)) {
        reach.push_back(drainage.grid().at(at));
        if (static_cast<std::int64_t>(reach.size()) > steps || !goes_on(drainage.direction[at])) {
            return;
        }
    }
}

bool is_straight(std::vector<Cell> const& reach, double tolerance) {
    std::int64_t const across = reach.back().col - reach.front().col;
    std::int64_t const down = reach.back().row - reach.front().row;
    auto const chord = std::sqrt(static_cast<double>(across * across + down * down));
    return chord >= 1.0 && std::all_of(reach.begin(), reach.end(), [&](Cell at) {
               std::int64_t const area = (at.row - reach.front().row) * across - (at.col - reach.front().col) * down;
               return std::fabs(static_cast<double>(area)) <= tolerance * chord;
           });
}

struct RowOfReaches {
    std::int64_t longest_run = 0;
    std::int64_t reaches = 0;
    std::int64_t straight = 0;

    RowOfReaches& operator+=(RowOfReaches const& more) {
        longest_run = std::max(longest_run, more.longest_run);
        reaches += more.reaches;
        straight += more.straight;
        return *this;
    }
};

RowOfReaches row_of(Channels const& channels, RowIndex r) {
    Grid const& grid = channels.drainage.grid();
    RowOfReaches row;
    std::vector<Cell> reach;
    for (ColumnIndex c = 0; c < grid.width; ++c) {
        std::int64_t const cell = grid.index({c, r});
        if (!channels.contains(cell)) {
            continue;
        }
        if (!run_goes_on_upstream(channels, {c, r}, channels.drainage.direction[cell])) {
            row.longest_run = std::max(row.longest_run, run_from(channels.drainage, cell));
        }
        walk(channels.drainage, cell, channels.params.reach_steps, reach);
        if (static_cast<std::int64_t>(reach.size()) > channels.params.reach_steps) {
            ++row.reaches;
            row.straight += is_straight(reach, channels.params.tolerance_cells) ? 1 : 0;
        }
    }
    return row;
}

} // namespace

StraightChannels straight_channels(flow::FlowField const& drainage, StraightChannelsParams const& params,
                                   Run const& run) {
    constexpr char const* self = "measure.straight_channels";
    require_in(self, "support_cells", params.support_cells, Range::at_least(1));
    require_in(self, "reach_steps", params.reach_steps, Range::at_least(2));
    require_in(self, "tolerance_cells", params.tolerance_cells, Range::at_least(0.0));
    Channels const channels{drainage, params};
    RowOfReaches const all = sum_rows(run, drainage.grid().height, [&](RowIndex r) {
        run.check();
        return row_of(channels, r);
    });
    StraightChannels found{all.longest_run, all.reaches};
    if (all.reaches > 0) {
        found.straight_share = static_cast<double>(all.straight) / static_cast<double>(all.reaches);
    }
    return found;
}

} // namespace thalweg::measure
