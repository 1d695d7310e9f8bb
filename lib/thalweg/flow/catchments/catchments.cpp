// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/catchments/catchments.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/error.hpp>

namespace thalweg::flow {

namespace {

constexpr std::int32_t nowhere = -1;

void require_countable(std::size_t count, char const* what) {
    if (std::cmp_greater(count, std::numeric_limits<std::int32_t>::max())) {
        throw BadInput(fmt::format("flow.catchments: {} {}, 2^31 or more", count, what));
    }
}

} // namespace

Raster<std::int32_t> first_met(std::vector<RiverCell> const& cells, FlowField const& drainage, Run const& run) {
    constexpr std::int32_t unknown = -2;
    require_countable(cells.size(), "river cells");
    Grid const& grid = drainage.direction.grid();
    Raster<std::int32_t> to(grid, unknown);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (drainage.direction[cells[i].cell] != Direction::no_data) {
            to[cells[i].cell] = static_cast<std::int32_t>(i);
        }
    }
    std::vector<std::int64_t> way;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        way.clear();
        std::int64_t at = i;
        while (to[at] == unknown) {
            way.push_back(at);
            std::int64_t const next = drainage.receiver(at);
            if (next < 0) {
                to[at] = nowhere;
                break;
            }
            at = next;
        }
        std::int32_t const end = to[at];
        for (std::int64_t const cell : way) {
            to[cell] = end;
        }
    }
    return to;
}

Catchments catchments(Reaches const& reaches, FlowField const& drainage, Run const& run) {
    require_countable(reaches.size(), "reaches");
    auto const steps = steps_to_outlet(reaches);
    Indexed<std::int32_t, RiverCell> const cells = river_cells(reaches, drainage.direction.grid(), run);
    Catchments result{first_met(cells, drainage, run), Indexed<ReachId, std::int64_t>(reaches.size(), 0), {}, 0};
    for (std::int64_t i = 0; i < result.reach.cells(); ++i) {
        if (std::int32_t& place = result.reach[i]; place >= 0) {
            std::size_t const reach = cells[place].reach;
            ++result.cells[reach];
            place = static_cast<std::int32_t>(reach);
        } else {
            result.without += drainage.direction[i] == Direction::no_data ? 0 : 1;
        }
    }
    result.upstream = result.cells;
    std::vector<std::size_t> downstream_order(reaches.size());
    std::iota(downstream_order.begin(), downstream_order.end(), std::size_t{0});
    std::stable_sort(downstream_order.begin(), downstream_order.end(),
                     [&](std::size_t a, std::size_t b) { return steps[a] > steps[b]; });
    for (std::size_t const a : downstream_order) {
        if (reaches[a].ds >= 0) {
            result.upstream[reaches[a].ds] += result.upstream[a];
        }
    }
    return result;
}

} // namespace thalweg::flow
