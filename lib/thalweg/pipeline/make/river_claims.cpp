// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/river_claims.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <thalweg/core/cells.hpp>

namespace thalweg::pipeline {

namespace {

bool lies_on(Grid const& grid, Vec3 const& at) {
    return at.x >= grid.west && at.x <= grid.east() && at.y >= grid.south() && at.y <= grid.north; // never NaN
}

} // namespace

Mask still_cells(NetworkFile const& network, Grid const& grid) {
    Mask still;
    if (!network.says.heights) {
        return still;
    }
    for (NetworkFile::FileArc const& arc : network.arcs) {
        for (std::size_t i = 1; i < arc.line.size(); ++i) {
            Vec3 const& a = arc.line[i - 1];
            Vec3 const& b = arc.line[i];
            if (!(a.z == b.z) || !lies_on(grid, a) || !lies_on(grid, b)) {
                continue;
            }
            still = still.cells() == 0 ? Mask(grid) : std::move(still);
            for (Cell const cell : cells_along({plan(a), plan(b)}, grid)) {
                still[cell] = 1;
            }
        }
    }
    return still;
}

Mask lake_cells(Channels const& channels) {
    Mask lakes;
    for (std::size_t n = 0; n < channels.level.size(); ++n) {
        if (channels.level[n] != 0) {
            lakes = lakes.cells() == 0 ? Mask(channels.grid) : std::move(lakes);
            lakes[channels.cell[n]] = 1;
            lakes[channels.cell[static_cast<std::size_t>(channels.receiver[n])]] = 1;
        }
    }
    return lakes;
}

Mask either(Mask one, Mask const& other) {
    if (one.cells() == 0) {
        return other;
    }
    for (std::int64_t i = 0; i < other.cells(); ++i) {
        one[i] = one[i] != 0 || other[i] != 0 ? 1 : 0;
    }
    return one;
}

std::vector<std::int64_t> sinks_of(NetworkFile const& network, Raster<float> const& dem) {
    Grid const& grid = dem.grid();
    std::vector<std::int64_t> sinks;
    for (NetworkFile::FileNode const& node : network.nodes) {
        if (node.columns.kind == name_of(NodeKind::sink) && lies_on(grid, node.at)) {
            std::int64_t const cell = grid.index(cells_of_vertices({plan(node.at)}, grid).front());
            if (!std::isnan(dem[cell])) {
                sinks.push_back(cell);
            }
        }
    }
    return sinks;
}

std::vector<NodeId> sinks_in(StreamNetwork const& network, NetworkFile const& file) {
    std::set<std::pair<double, double>> places;
    for (NetworkFile::FileNode const& node : file.nodes) {
        if (node.columns.kind == name_of(NodeKind::sink)) {
            places.emplace(node.at.x, node.at.y);
        }
    }
    std::vector<NodeId> sinks;
    for (NodeId const outlet : network.outlets()) {
        if (places.contains({network.node(outlet).at.x, network.node(outlet).at.y})) {
            sinks.push_back(outlet);
        }
    }
    return sinks;
}

std::vector<NodeId> inland_ends(StreamNetwork const& network, Raster<float> const& dem) {
    Grid const& grid = dem.grid();
    std::vector<NodeId> ends;
    for (NodeId const outlet : network.outlets()) {
        Cell const at = cells_of_vertices({network.node(outlet).at}, grid).front();
        bool const goes_on = std::all_of(d8_steps.begin(), d8_steps.end(), [&](Cell step) {
            Cell const n{at.col + step.col, at.row + step.row};
            return grid.contains(n) && !std::isnan(dem[n]);
        });
        if (goes_on) {
            ends.push_back(outlet);
        }
    }
    return ends;
}

std::vector<std::int64_t> cells_of(std::vector<NodeId> const& nodes, StreamNetwork const& network, Grid const& grid) {
    std::vector<std::int64_t> cells;
    for (NodeId const node : nodes) {
        cells.push_back(grid.index(cells_of_vertices({network.node(node).at}, grid).front()));
    }
    return cells;
}

Mask river_mask(Valley const& valley) {
    Mask cells(valley.z.grid());
    for (std::int64_t i = 0; i < cells.cells(); ++i) {
        cells[i] = std::isnan(valley.z[i]) ? 0 : 1;
    }
    return cells;
}

Valley honoured_valley(Valley valley, StreamNetwork const& network, Raster<float> const& dem) {
    Grid const& grid = dem.grid();
    Mask honoured(grid);
    std::vector<std::uint8_t> cut(network.node_count(), 0); // by node: water from here does not come to the outlet
    for (NodeId const node : network.upstream_order()) {
        if (network.out(node) == no_arc) {
            continue;
        }
        auto const arc = network.out(node);
        bool is_cut = cut[network.to(arc)] != 0;
        std::vector<Cell> const cells = cells_along(network.arc(arc).line, grid);
        for (auto cell = cells.rbegin(); cell != cells.rend(); ++cell) {
            is_cut = is_cut || !(valley.z[*cell] == dem[*cell] || std::isnan(valley.z[*cell]));
            honoured[*cell] = is_cut ? honoured[*cell] : 1;
        }
        cut[node] = is_cut ? 1 : 0;
    }
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        valley.z[i] = honoured[i] != 0 ? valley.z[i] : std::numeric_limits<float>::quiet_NaN();
    }
    return valley;
}

} // namespace thalweg::pipeline
