// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/side_valleys.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/segment_grid.hpp>

// Described in docs/equilibrium.md.

namespace thalweg::network {
namespace {

// A position on an input arc.
struct PlaceOnArc {
    std::size_t arc = 0;
    std::size_t segment = 0;
    double along = 0.0; // [0, 1) on the segment
    Vec2 at;

    friend bool operator<(PlaceOnArc const& a, PlaceOnArc const& b) {
        return std::tie(a.arc, a.segment, a.along) < std::tie(b.arc, b.segment, b.along);
    }
};

std::size_t segments_of(StreamNetwork const& plan) {
    std::size_t segments = 0;
    for (ArcId arc = 0; arc < plan.arc_count(); ++arc) {
        segments += plan.arc(arc).line.size() - 1;
    }
    return segments;
}

// Index of the lines of input rivers.
class DrawnLines {
public:
    DrawnLines(StreamNetwork const& plan, Grid const& grid)
        : plan_(plan), cell_m_(grid.cell_m),
          segments_({grid.west, grid.south()}, {grid.east(), grid.north}, 4.0 * grid.cell_m, segments_of(plan)) {
        for (std::size_t a = 0; a < plan.arc_count(); ++a) {
            std::vector<Vec2> const& line = plan.arc(a).line;
            for (std::size_t k = 0; k + 1 < line.size(); ++k) {
                segments_.add(owners_.size(), {line[k], line[k + 1]});
                owners_.emplace_back(a, k);
            }
        }
    }

    bool come_near(geometry::Segment const& s, double margin_cells) const {
        double const margin = margin_cells * cell_m_;
        return !segments_.near(
            s, margin, [&](std::size_t n) { return geometry::squared_distance(segments_[n], s) > margin * margin; });
    }

    // The position nearest to p (ties: the first); nothing within a few cells.
    std::optional<PlaceOnArc> nearest(Vec2 p) const {
        for (double reach = first_reach_cells; reach <= last_reach_cells; reach *= 2.0) {
            double best = reach * cell_m_;
            std::optional<std::size_t> found;
            segments_.near({p, p}, best, [&](std::size_t n) {
                double const d = distance(p, geometry::foot_on(segments_[n].a, segments_[n].b, p).at);
                if (d < best || (d == best && found && owners_[n] < owners_[*found])) {
                    best = d;
                    found = n;
                }
                return true;
            });
            if (found) {
                auto const [arc, segment] = owners_[*found];
                geometry::Foot const foot = geometry::foot_on(segments_[*found].a, segments_[*found].b, p);
                return settled({arc, segment, foot.along, foot.at});
            }
        }
        return std::nullopt;
    }

private:
    // The search radius doubles from this, so that few segments are examined.
    static constexpr double first_reach_cells = 1.5;
    static constexpr double last_reach_cells = 12.0;
    static constexpr double same_cells = 1e-3; // positions closer than this are equal

    // The position, moved to an adjacent vertex.
    PlaceOnArc settled(PlaceOnArc place) const {
        std::vector<Vec2> const& line = plan_.arc(place.arc).line;
        double const near = same_cells * cell_m_;
        if (distance(place.at, line[place.segment + 1]) <= near) {
            return {place.arc, place.segment + 1, 0.0, line[place.segment + 1]};
        }
        return distance(place.at, line[place.segment]) <= near
                   ? PlaceOnArc{place.arc, place.segment, 0.0, line[place.segment]}
                   : place;
    }

    StreamNetwork const& plan_;
    double cell_m_;
    geometry::SegmentGrid segments_;
    std::vector<std::pair<std::size_t, std::size_t>> owners_; // by segment: its arc and index there
};

constexpr double on_line_cells = 0.3; ///< a cell whose centre is this close to a drawn line belongs to that river
constexpr double least_fall_m = 1e-3;

enum CellKind : std::uint8_t { nothing, valley, last, outlet };

/// A valley grown by the terrain, between nodes.
struct Grown {
    std::vector<std::int64_t> cells; ///< downstream; the last is a node or, at a confluence, the cell before the line
    std::optional<PlaceOnArc> join;
};

/// A DEM and its flow.
struct DemFlow {
    Raster<float> const& dem;
    flow::FlowField const& flow;
};

/// The cells of valleys, and where their water goes.
class Valleys {
public:
    Valleys(Channels const& channels, DemFlow const& water, DrawnLines const& lines, std::int64_t support,
            Run const& run)
        : water_(water), grid_(water.dem.grid()), kind_(grid_, nothing) {
        std::vector<std::int64_t> cells;
        Mask river(grid_);
        for (std::int64_t const cell : channels.cell) {
            river[cell] = 1;
        }
        for (std::int64_t i = 0; i < grid_.cells(); ++i) {
            if (i % (1 << 20) == 0) {
                run.check();
            }
            if (river[i] == 0 && water.flow.area_cells[i] >= support && std::isfinite(water.dem[i]) &&
                !lines.come_near({centre(i), centre(i)}, on_line_cells)) {
                kind_[i] = valley;
                cells.push_back(i);
            }
        }
        for (std::int64_t const i : cells) {
            std::int64_t const next = below(i);
            bool const stays = next >= 0 && kind_[next] != nothing;
            kind_[i] = next < 0 || grid_.on_border(grid_.at(i))                                    ? outlet
                       : stays && !lines.come_near({centre(i), centre(next)}, 0.5 * on_line_cells) ? valley
                                                                                                   : last;
            cut_ += kind_[i] == last && river[next] == 0 ? 1 : 0;
        }
    }

    std::int64_t cut() const { return cut_; }
    Vec2 centre(std::int64_t i) const { return grid_.centre(grid_.at(i)); }
    void take_away(std::int64_t i) { kind_[i] = nothing; }

    std::vector<Grown> trace(DrawnLines const& lines) const {
        Raster<std::uint8_t> arriving(grid_);
        for (std::int64_t i = 0; i < grid_.cells(); ++i) {
            if (kind_[i] == valley && kind_[below(i)] != nothing) {
                ++arriving[below(i)];
            }
        }
        std::vector<Grown> all;
        for (std::int64_t i = 0; i < grid_.cells(); ++i) {
            if (kind_[i] == nothing || arriving[i] == 1 || kind_[i] == outlet) {
                continue;
            }
            Grown grown{{i}, {}};
            std::int64_t at = i;
            while (kind_[at] == valley && (at == i || arriving[at] == 1)) {
                at = below(at);
                grown.cells.push_back(at);
            }
            bool const ends_in_node = at != i && (arriving[at] != 1 || kind_[at] == outlet);
            if (!ends_in_node) {
                grown.join = lines.nearest(centre(grown.cells.back()));
                if (!grown.join) {
                    continue;
                }
            }
            all.push_back(std::move(grown));
        }
        return all;
    }

private:
    std::int64_t below(std::int64_t i) const { return water_.flow.receiver(i); }

    DemFlow const& water_;
    Grid grid_;
    Raster<std::uint8_t> kind_;
    std::int64_t cut_ = 0;
};

/// Joins input arcs and grown valleys.
class Grafting {
public:
    Grafting(ElevatedNetwork const& given, DemFlow const& water) : given_(given), water_(water) {}

    ElevatedNetwork join(std::vector<Grown> const& grown) {
        out_ = {};
        plan_ = {};
        for (NodeId n = 0; n < given_.planform.node_count(); ++n) {
            add_node(given_.planform.node(n).at, given_.node_z[n]);
        }
        cut_given(grown);
        add_grown(grown);
        out_.planform = std::move(plan_);
        return std::move(out_);
    }

private:
    NodeId add_node(Vec2 at, double z) {
        out_.node_z.push_back(z);
        return plan_.add_node(at);
    }

    void cut_given(std::vector<Grown> const& grown) {
        std::vector<PlaceOnArc> places;
        for (Grown const& g : grown) {
            if (g.join) {
                places.push_back(*g.join);
            }
        }
        std::sort(places.begin(), places.end());
        nodes_.clear();
        auto place = places.begin();
        for (std::size_t a = 0; a < given_.planform.arc_count(); ++a) {
            Arc const& arc = given_.planform.arc(a);
            std::vector<double> const& z = given_.arc_z[a];
            Arc piece = arc;
            piece.line = {arc.line.front()};
            std::vector<double> heights{z.front()};
            NodeId from = given_.planform.from(a);
            auto const end_at = [&](NodeId node, double height) {
                plan_.add_arc(from, node, piece);
                out_.arc_z.push_back(heights);
                from = node;
                piece.line = {plan_.nodes[node].at};
                heights = {height};
            };
            for (std::size_t k = 0; k + 1 < arc.line.size(); ++k) {
                for (; place != places.end() && place->arc == a && place->segment == k; ++place) {
                    NodeId const node = node_at(*place, a, from, z);
                    if (node == from) {
                        continue;
                    }
                    if (place->along > 0.0) { // otherwise the vertex exists
                        piece.line.push_back(place->at);
                        heights.push_back(out_.node_z[node]);
                    }
                    end_at(node, out_.node_z[node]);
                }
                piece.line.push_back(arc.line[k + 1]);
                heights.push_back(z[k + 1]);
            }
            for (; place != places.end() && place->arc == a; ++place) { // at its last vertex
                nodes_[key_of(*place)] = given_.planform.to(a);
            }
            plan_.add_arc(from, given_.planform.to(a), std::move(piece));
            out_.arc_z.push_back(std::move(heights));
        }
    }

    using Key = std::tuple<std::size_t, std::size_t, double>;
    static Key key_of(PlaceOnArc const& p) { return {p.arc, p.segment, p.along}; }

    /// The node at which a valley joins an arc; reuses `from`, the last one on it, at the same position.
    NodeId node_at(PlaceOnArc const& place, std::size_t a, NodeId from, std::vector<double> const& z) {
        bool const at_source = place.segment == 0 && place.along == 0.0;
        auto const [entry, is_new] = nodes_.try_emplace(key_of(place), given_.planform.from(a));
        if (at_source || !is_new) {
            return at_source ? from : entry->second;
        }
        if (plan_.nodes[from].at == place.at) {
            entry->second = from;
            return from;
        }
        double const low = z[std::min(place.segment + 1, z.size() - 1)];
        entry->second = add_node(place.at, z[place.segment] + (low - z[place.segment]) * place.along);
        return entry->second;
    }

    void add_grown(std::vector<Grown> const& grown) {
        std::map<std::int64_t, NodeId> at_cell;
        auto const node_of = [&](std::int64_t cell) {
            auto const [entry, is_new] = at_cell.try_emplace(cell, 0);
            if (is_new) {
                Grid const& grid = water_.dem.grid();
                entry->second = add_node(grid.centre(grid.at(cell)), static_cast<double>(water_.dem[cell]));
            }
            return entry->second;
        };
        std::vector<std::pair<NodeId, NodeId>> ends;
        std::vector<std::size_t> order; // downstream first: contributing areas decrease
        for (std::size_t g = 0; g < grown.size(); ++g) {
            NodeId const from = node_of(grown[g].cells.front());
            ends.emplace_back(from, grown[g].join ? nodes_.at(key_of(*grown[g].join)) : node_of(grown[g].cells.back()));
            order.push_back(g);
        }
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return water_.flow.area_cells[grown[a].cells.front()] > water_.flow.area_cells[grown[b].cells.front()];
        });
        std::vector<std::vector<double>> heights(grown.size());
        for (std::size_t const g : order) {
            std::vector<double>& z = heights[g];
            z.push_back(out_.node_z[ends[g].second]);
            std::size_t const own = grown[g].cells.size() - (grown[g].join ? 0 : 1);
            for (std::size_t i = own; i-- > 0;) {
                z.push_back(std::max(static_cast<double>(water_.dem[grown[g].cells[i]]), z.back() + least_fall_m));
            }
            std::reverse(z.begin(), z.end());
            out_.node_z[ends[g].first] = z.front();
        }
        Grid const& grid = water_.dem.grid();
        for (std::size_t g = 0; g < grown.size(); ++g) {
            Arc arc;
            arc.is_input = false;
            for (std::int64_t const cell : grown[g].cells) {
                arc.line.push_back(grid.centre(grid.at(cell)));
            }
            if (grown[g].join) {
                arc.line.push_back(grown[g].join->at);
            }
            plan_.add_arc(ends[g].first, ends[g].second, std::move(arc));
            out_.arc_z.push_back(std::move(heights[g]));
        }
    }

    ElevatedNetwork const& given_;
    DemFlow const& water_;
    ElevatedNetwork out_;
    NetworkDraft plan_;
    std::map<Key, NodeId> nodes_;
};

/// Grown arcs that meet others away from nodes: their numbers among the grown, ascending.
std::vector<std::size_t> offenders(StreamNetwork const& plan, std::size_t grown, Run const& run) {
    std::vector<std::vector<Vec2>> lines;
    std::vector<geometry::EndNodes> ends;
    for (std::size_t a = 0; a < plan.arc_count(); ++a) {
        lines.push_back(plan.arc(a).line);
        ends.push_back({plan.from(a), plan.to(a)});
    }
    std::size_t const first = plan.arc_count() - grown;
    std::vector<std::size_t> found;
    for (geometry::Meeting const& m : geometry::meetings(lines, ends, run)) {
        if (std::size_t const later = std::max(m.line, m.other); later >= first) {
            found.push_back(later - first);
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

/// With every valley that flows into a removed one.
std::vector<std::size_t> with_upstream(std::vector<Grown> const& grown, std::vector<std::size_t> out) {
    std::map<std::int64_t, std::vector<std::size_t>> ends_in;
    for (std::size_t g = 0; g < grown.size(); ++g) {
        if (!grown[g].join) {
            ends_in[grown[g].cells.back()].push_back(g);
        }
    }
    std::vector<std::uint8_t> taken(grown.size());
    std::vector<std::size_t> all;
    while (!out.empty()) {
        std::size_t const g = out.back();
        out.pop_back();
        if (taken[g]++ != 0) {
            continue;
        }
        all.push_back(g);
        if (auto const above = ends_in.find(grown[g].cells.front()); above != ends_in.end()) {
            out.insert(out.end(), above->second.begin(), above->second.end());
        }
    }
    return all;
}

void require_one_grid(Channels const& channels, DemFlow const& water) {
    Grid const& grid = water.dem.grid();
    for (Grid const& other : {water.flow.grid(), water.flow.area_cells.grid(), channels.grid}) {
        require_same_grid(grid, other, "network.side_valleys", "the land and its channels or water", "drain this land");
    }
}

} // namespace

SideValleys side_valleys(ElevatedNetwork const& given, Channels const& channels, Raster<float> const& dem,
                         flow::FlowField const& flow, SideValleysParams const& params, Run const& run) {
    DemFlow const water{dem, flow};
    require_in("network.side_valleys", "the support", params.support_cells, Range::at_least(1), "cells");
    require_one_grid(channels, water);
    DrawnLines const lines(given.planform, water.dem.grid());
    Valleys valleys(channels, water, lines, params.support_cells, run);
    Grafting grafting(given, water);
    SideValleys made;
    made.cut = valleys.cut();
    for (;;) {
        std::vector<Grown> const grown = valleys.trace(lines);
        made.network = grafting.join(grown);
        made.grown = static_cast<std::int64_t>(grown.size());
        std::vector<std::size_t> const out = with_upstream(grown, offenders(made.network.planform, grown.size(), run));
        if (out.empty()) {
            return made;
        }
        made.left_out += static_cast<std::int64_t>(out.size());
        for (std::size_t const g : out) {
            std::size_t const own = grown[g].cells.size() - (grown[g].join ? 0 : 1);
            for (std::size_t i = 0; i < own; ++i) {
                valleys.take_away(grown[g].cells[i]);
            }
        }
    }
}

} // namespace thalweg::network
