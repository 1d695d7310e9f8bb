// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/river_claims.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/network/import/prepare_lines.hpp>

namespace thalweg::make {
namespace {

bool lies_on(Grid const& grid, Vec3 const& at) {
    return at.x >= grid.west && at.x <= grid.east() && at.y >= grid.south() && at.y <= grid.north; // never NaN
}

using Places = std::unordered_map<std::int64_t, std::int64_t>;

std::int64_t place_in(Places const& places, std::int64_t key) {
    auto const found = places.find(key);
    return found == places.end() ? -1 : found->second;
}

bool inside(std::vector<Vec3> const& line, Grid const& grid) {
    return std::all_of(line.begin(), line.end(), [&](Vec3 const& v) {
        return v.x >= grid.west && v.x <= grid.east() && v.y >= grid.south() && v.y <= grid.north;
    });
}

bool is_somewhere(std::vector<Vec3> const& line) {
    return std::all_of(line.begin(), line.end(), [](Vec3 const& v) { return is_finite(in_plan(v)); });
}

std::vector<std::vector<Vec2>> parts_in(std::vector<Vec3> const& line, Grid const& grid) {
    if (line.empty() || !is_somewhere(line)) {
        return {};
    }
    if (inside(line, grid)) { // bit for bit
        return {in_plan(line)};
    }
    RiverLines whole;
    whole.lines.push_back({0, line, {}, 0, 0});
    std::vector<std::vector<Vec2>> parts;
    for (RiverLine const& part : network::clip_lines(whole, grid).lines) {
        parts.push_back(in_plan(part.vertices));
    }
    return parts;
}

/// By reach: the basin of the file if it has any; else 1, 2, ... by the node at its outlet.
std::vector<std::int64_t> basins_of(NetworkFile const& file, std::vector<flow::Reach> const& reaches,
                                    std::vector<std::size_t> const& first_arc) {
    std::vector<std::int64_t> basins;
    bool const told = file.says.basin && std::all_of(file.arcs.begin(), file.arcs.end(),
                                                     [](NetworkFile::FileArc const& a) { return a.basin > 0; });
    if (told) {
        for (std::size_t const arc : first_arc) {
            basins.push_back(file.arcs[arc].basin);
        }
        return basins;
    }
    basins.assign(reaches.size(), 0);
    Places known;
    std::vector<std::size_t> way;
    for (std::size_t start = 0; start < reaches.size(); ++start) {
        way.clear();
        std::size_t at = start;
        while (basins[at] == 0 && reaches[at].ds >= 0) {
            way.push_back(at);
            at = static_cast<std::size_t>(reaches[at].ds);
        }
        if (basins[at] == 0) {
            auto const next = static_cast<std::int64_t>(known.size()) + 1;
            basins[at] = known.try_emplace(file.arcs[first_arc[at]].to_node, next).first->second;
        }
        for (std::size_t const above : way) {
            basins[above] = basins[at];
        }
    }
    return basins;
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
            for (Cell const cell : cells_along({in_plan(a), in_plan(b)}, grid)) {
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
            std::int64_t const cell = grid.index(cells_of_vertices({in_plan(node.at)}, grid).front());
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

Mask river_mask(ValleyCells const& valley) {
    Mask cells(valley.grid);
    for (CellIndex const cell : valley.cell) {
        cells[cell] = 1;
    }
    return cells;
}

ValleyCells honoured_valley(ValleyCells const& valley, StreamNetwork const& network, Raster<float> const& dem) {
    Grid const& grid = dem.grid();
    Mask honoured(grid);
    std::vector<std::uint8_t> cut(network.node_count(), 0); // by node: water from here does not reach the outlet
    for (NodeId const node : network.upstream_order()) {
        if (network.out(node) == no_arc) {
            continue;
        }
        auto const arc = network.out(node);
        bool is_cut = cut[network.to(arc)] != 0;
        std::vector<Cell> const cells = cells_along(network.arc(arc).line, grid);
        for (auto cell = cells.rbegin(); cell != cells.rend(); ++cell) {
            float const z = height_in(valley, grid.index(*cell));
            is_cut = is_cut || !(z == dem[*cell] || std::isnan(z));
            honoured[*cell] = is_cut ? honoured[*cell] : 1;
        }
        cut[node] = is_cut ? 1 : 0;
    }
    ValleyCells kept{.grid = valley.grid};
    for (std::size_t i = 0; i < valley.cell.size(); ++i) {
        if (honoured[valley.cell[i]] != 0) {
            kept.cell.push_back(valley.cell[i]);
            kept.z.push_back(valley.z[i]);
        }
    }
    return kept;
}

FileReaches reaches_of_file(NetworkFile const& file, Grid const& grid) {
    FileReaches result;
    Places places;
    std::vector<std::size_t> first_arc;
    for (std::size_t i = 0; i < file.arcs.size(); ++i) {
        auto const& arc = file.arcs[i];
        auto const next = static_cast<std::int64_t>(result.reaches.size());
        auto const [place, fresh] = places.try_emplace(arc.id, next);
        if (fresh) {
            result.reaches.push_back({{}, -1, arc.id});
            first_arc.push_back(i);
        } else if (file.arcs[first_arc[static_cast<std::size_t>(place->second)]].ds_arc != arc.ds_arc) {
            throw BadInput("make.reaches_of_file",
                           fmt::format("arcs of the id {} run into several; see what thalweg check says", arc.id));
        }
        auto& lines = result.reaches[static_cast<std::size_t>(place->second)].lines;
        auto parts = parts_in(arc.line, grid);
        result.nowhere += is_somewhere(arc.line) ? 0 : 1;
        std::move(parts.begin(), parts.end(), std::back_inserter(lines));
    }
    std::vector<bool> leaves(result.reaches.size(), false);
    for (auto const& arc : file.arcs) {
        auto const reach = static_cast<std::size_t>(places.at(arc.id));
        leaves[reach] = leaves[reach] || !inside(arc.line, grid);
        result.reaches[reach].ds = place_in(places, arc.ds_arc);
    }
    try {
        flow::steps_to_outlet(result.reaches);
    } catch (BadInput const& cycle) {
        throw BadInput("make.reaches_of_file", cycle.what());
    }
    for (std::size_t i = 0; i < result.reaches.size(); ++i) {
        bool const none = result.reaches[i].lines.empty();
        result.outside += none ? 1 : 0;
        result.cut += leaves[i] && !none ? 1 : 0;
    }
    refuse_if<BadInput>(result.outside == static_cast<std::int64_t>(result.reaches.size()), "make.reaches_of_file",
                        "none of {} arcs lies on the DEM, which reaches from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f})",
                        file.arcs.size(), grid.west, grid.south(), grid.east(), grid.north);
    result.basins = basins_of(file, result.reaches, first_arc);
    return result;
}

} // namespace thalweg::make
