// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/carry_outlets.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/indexed.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>
#include <thalweg/network/planform/internal/carry_ground.hpp>
#include <thalweg/network/planform/internal/way_out.hpp>

namespace thalweg::network {

namespace {

/// Which basins have become one.
class Basins {
public:
    explicit Basins(std::size_t count) : into_(count) { std::iota(into_.begin(), into_.end(), std::int64_t{0}); }

    std::int64_t root(std::int64_t basin) const {
        while (into_[basin] != basin) {
            basin = into_[basin];
        }
        return basin;
    }
    void join(std::int64_t basin, std::int64_t into) { into_[root(basin)] = root(into); }

private:
    Indexed<std::int64_t, std::int64_t> into_;
};

/// A network in which rivers end in vertices of others: those become nodes.
/// ends: nodes that lie on such a vertex.
NetworkDraft joined(StreamNetwork const& network, std::vector<NodeId> const& ends) {
    std::map<std::pair<double, double>, NodeId> node_at;
    std::vector<std::uint8_t> is_end(network.node_count(), 0);
    for (NodeId const n : ends) {
        is_end[n] = 1;
    }
    NetworkDraft out;
    std::vector<NodeId> node(is_end.size());
    for (NodeId n = 0; n < node.size(); ++n) {
        auto const place = std::pair(network.node(n).at.x, network.node(n).at.y);
        auto const known = is_end[n] != 0 ? node_at.find(place) : node_at.end();
        node[n] = known != node_at.end() ? known->second : out.add_node(network.node(n).at);
        if (is_end[n] != 0) {
            node_at.emplace(place, node[n]);
        }
    }
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        Arc piece = network.arc(arc);
        std::vector<Vec2> const line = std::move(piece.line);
        NodeId from = node[network.from(arc)];
        piece.line = {line.front()};
        for (std::size_t i = 1; i < line.size(); ++i) {
            piece.line.push_back(line[i]);
            auto const known = node_at.find({line[i].x, line[i].y});
            if (i + 1 < line.size() && known != node_at.end()) {
                out.add_arc(from, known->second, piece);
                from = known->second;
                piece.line = {line[i]};
            }
        }
        out.add_arc(from, node[network.to(arc)], piece);
    }
    return out;
}

/// Outlets inside the grid, within reach of an end. The nearest to an end go first: their short ways leave the others
/// the most room.
std::vector<NodeId> outlets_inside(StreamNetwork const& network, Grid const& grid, RiverEnds const& ends,
                                   std::int64_t reach_cells) {
    std::vector<std::pair<std::int64_t, NodeId>> inside;
    for (NodeId const outlet : network.outlets()) {
        Cell const cell = cells_along({network.node(outlet).at}, grid).front();
        if (std::int64_t const steps = ends.steps(cell); steps > 0 && steps <= reach_cells) {
            inside.emplace_back(steps, outlet);
        }
    }
    std::sort(inside.begin(), inside.end());
    std::vector<NodeId> outlets;
    for (auto const& [steps, outlet] : inside) {
        outlets.push_back(outlet);
    }
    return outlets;
}

/// A network that is drawn on.
class Carrying {
public:
    Carrying(StreamNetwork const& network, Grid const& grid, RiverEnds const& ends, CarryParams const& params)
        : network_(network), ends_(ends), params_(params), ground_(grid, params), basins_(network.outlets().size() + 1),
          longer_(network.draft()) {
        for (std::size_t a = 0; a < network.arc_count(); ++a) {
            ground_.add(network.arc(a).line, network.basin(network.from(a)), fmt::format("arc {}", a + 1));
        }
    }

    /// Draws the river of an outlet on, and says so; or says that there is no way.
    Finding carry(NodeId outlet) {
        Vec2 const at = network_.node(outlet).at;
        std::int64_t const basin = network_.basin(outlet);
        Way const way =
            way_out(at, cells_along({at}, ground_.grid()).front(), ground_, ends_, [&](Confluence const& into) {
                return params_.join && basins_.root(into.basin) != basins_.root(basin);
            });
        Finding note;
        auto const last = network_.in(outlet).front();
        std::int64_t const feature = network_.arc(last).feature;
        note.feature = feature != 0 ? feature : static_cast<std::int64_t>(last) + 1;
        note.where = at;
        if (way.cells.empty()) {
            note.kind = "closed_basin";
            note.text = fmt::format("the outlet at ({:.3f}, {:.3f}) stays inside the grid: every way to its border "
                                    "meets a river",
                                    at.x, at.y);
            return note;
        }
        bool const joins = way.into != nullptr;
        std::vector<Vec2> line = line_of(way, at);
        if (joins) {
            basins_.join(basin, way.into->basin);
        }
        char const* const to = joins ? "river" : ends_.at_border(way.cells.back()) ? "border" : "coast";
        ground_.add(line, basin, "a carried outlet"); // what is joined moves no more: way is done with
        note.kind = joins ? "joined_outlet" : "carried_outlet";
        note.amount = length_of(line);
        note.text = fmt::format("the outlet at ({:.3f}, {:.3f}) was carried {:.3f} m to the {} at ({:.3f}, {:.3f})",
                                at.x, at.y, note.amount, to, line.back().x, line.back().y);
        NodeId const end = draw_on(outlet, std::move(line));
        if (joins) {
            confluences_.push_back(end);
        }
        return note;
    }

    /// The network with what was drawn; what is joined becomes two arcs.
    StreamNetwork take() {
        if (confluences_.empty()) {
            return std::move(longer_);
        }
        return joined(std::move(longer_), confluences_);
    }

private:
    std::vector<Vec2> line_of(Way const& way, Vec2 from) const {
        std::vector<Vec2> line{from};
        for (std::size_t i = 1; i < way.cells.size(); ++i) {
            line.push_back(ground_.grid().centre(way.cells[i]));
        }
        if (way.into != nullptr) {
            line.back() = way.into->at;
        }
        return line;
    }

    /// Lengthens the arc that ends in an outlet, or adds one where several do. Gives: the node at the end.
    NodeId draw_on(NodeId outlet, std::vector<Vec2> line) {
        auto const arriving = network_.in(outlet);
        if (arriving.size() == 1) {
            std::vector<Vec2>& drawn = longer_.arcs[arriving.front()].arc.line;
            drawn.insert(drawn.end(), line.begin() + 1, line.end());
            longer_.nodes[outlet].at = line.back();
            return outlet;
        }
        Arc trunk;
        trunk.persistence = 0.0;
        for (ArcId const a : arriving) {
            trunk.persistence = std::max(trunk.persistence, network_.arc(a).persistence);
        }
        NodeId const mouth = longer_.add_node(line.back());
        trunk.line = std::move(line);
        longer_.add_arc(outlet, mouth, std::move(trunk));
        return mouth;
    }

    StreamNetwork const& network_;
    RiverEnds const& ends_;
    CarryParams const& params_;
    CarryGround ground_;
    Basins basins_; // 0: none
    NetworkDraft longer_;
    std::vector<NodeId> confluences_;
};

Carried carry(StreamNetwork const& network, Grid const& grid, RiverEnds const& ends, std::int64_t reach_cells,
              CarryParams const& params) {
    require_trees(network, "network.carry_outlets");
    if (!(params.join_cells >= 0.0 && params.beside_cells >= 0.0)) {
        throw BadParameter(
            fmt::format("network.carry_outlets: joining costs {} cells, a cell beside a river {}; give 0 "
                        "or more",
                        params.join_cells, params.beside_cells));
    }
    Carrying carrying(network, grid, ends, params);
    Carried carried;
    for (NodeId const outlet : outlets_inside(network, grid, ends, reach_cells)) {
        carried.notes.push_back(carrying.carry(outlet));
    }
    carried.network = carrying.take();
    return carried;
}

} // namespace

Carried carry_outlets(StreamNetwork const& network, Grid const& grid, CarryParams const& params) {
    return carry(network, grid, RiverEnds(grid), std::numeric_limits<std::int64_t>::max(), params);
}

Carried carry_outlets(StreamNetwork const& network, Mask const& land, std::int64_t reach_cells,
                      CarryParams const& params) {
    return carry(network, land.grid(), RiverEnds(land), reach_cells, params);
}

} // namespace thalweg::network
