// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/catchments/reaches.hpp>

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include <thalweg/core/cells/cells_along.hpp>
#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/error.hpp>

namespace thalweg::flow {

Reaches reaches_of(StreamNetwork const& network) {
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if (network.out_arcs(n).size() > 1) {
            throw BadInput(fmt::format("flow.reaches_of: {} arcs leave node {} at ({}, {}); a river must not split",
                                       network.out_arcs(n).size(), n + 1, network.node(n).at.x, network.node(n).at.y));
        }
    }
    Reaches reaches;
    reaches.reserve(network.arc_count());
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        ArcId const below = network.out(network.to(a));
        reaches.push_back({{network.arc(a).line},
                           below == no_arc ? -1 : static_cast<std::int64_t>(below),
                           static_cast<std::int64_t>(a) + 1});
    }
    return reaches;
}

std::vector<std::int64_t> steps_to_outlet(Reaches const& reaches) {
    constexpr std::int64_t unknown = 0;
    constexpr std::int64_t on_the_way = -1;
    Indexed<ReachId, std::int64_t> steps(reaches.size(), unknown);
    std::vector<ReachId> way;
    for (ReachId start = 0; start < reaches.count(); ++start) {
        way.clear();
        std::int64_t below = 0;
        for (ReachId at = start; steps[at] <= 0;) {
            if (steps[at] == on_the_way) {
                throw BadInput(fmt::format("flow.steps_to_outlet: arc {} leads to no outlet: its rivers run in a "
                                           "circle; see what thalweg check says",
                                           reaches[at].id));
            }
            steps[at] = on_the_way;
            way.push_back(at);
            if (reaches[at].ds < 0) {
                break;
            }
            ReachId const next = reaches[at].ds;
            if (next >= reaches.count()) {
                throw BadInput(fmt::format("flow.steps_to_outlet: arc {} runs into reach {} of {}", reaches[at].id,
                                           next, reaches.size()));
            }
            at = next;
            below = std::max<std::int64_t>(steps[at], 0);
        }
        for (auto at = way.rbegin(); at != way.rend(); ++at) {
            steps[*at] = ++below;
        }
    }
    return steps;
}

std::vector<RiverCell> river_cells(Reaches const& reaches, Grid const& grid, Run const& run) {
    auto const steps = steps_to_outlet(reaches);
    std::vector<RiverCell> cells;
    for (std::size_t a = 0; a < reaches.size(); ++a) {
        run.check();
        for (auto const& line : reaches[a].lines) {
            for (Cell const c : cells_along(line, grid, fmt::format("arc {}", reaches[a].id))) {
                cells.push_back({grid.index(c), a});
            }
        }
    }
    std::sort(cells.begin(), cells.end(), [&](RiverCell const& p, RiverCell const& q) {
        return std::tie(p.cell, steps[p.reach], p.reach) < std::tie(q.cell, steps[q.reach], q.reach);
    });
    cells.erase(std::unique(cells.begin(), cells.end(),
                            [](RiverCell const& p, RiverCell const& q) { return p.cell == q.cell; }),
                cells.end());
    return cells;
}

} // namespace thalweg::flow
