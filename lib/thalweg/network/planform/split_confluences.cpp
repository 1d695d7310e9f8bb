// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/split_confluences.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/triangles.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>
#include <thalweg/network/planform/internal/shift_tributary.hpp>

namespace thalweg::network {

namespace {

double median_segment(StreamNetwork const& network) {
    std::vector<double> lengths;
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        auto const& line = network.arc(arc).line;
        for (std::size_t i = 1; i < line.size(); ++i) {
            lengths.push_back(distance(line[i - 1], line[i]));
        }
    }
    auto const middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    return *middle;
}

/// A network whose arcs can be cut and led elsewhere.
class Loose {
public:
    explicit Loose(ElevatedNetwork const& network) {
        for (NodeId n = 0; n < network.plan.node_count(); ++n) {
            in_.emplace_back(network.plan.in(n).begin(), network.plan.in(n).end());
            out_.push_back(network.plan.out(n));
            Vec2 const at = network.plan.node(n).at;
            nodes_.push_back({at.x, at.y, network.node_z[n]});
        }
        for (std::size_t a = 0; a < network.plan.arc_count(); ++a) {
            Line line;
            for (std::size_t i = 0; Vec2 const p : network.plan.arc(a).line) {
                line.push_back({p.x, p.y, network.arc_z[a][i++]});
            }
            lines_.push_back(std::move(line));
            from_.push_back(network.plan.from(a));
            to_.push_back(network.plan.to(a));
            cut_off_.emplace_back();
        }
    }

    std::size_t arcs_into(NodeId n) const { return in_[n].size(); }
    Vec3 at(NodeId n) const { return nodes_[n]; }
    Line const& line(std::size_t arc) const { return lines_[arc]; }
    std::vector<std::size_t> const& cut_off(std::size_t arc) const { return cut_off_[arc]; }
    std::vector<SplitPiece> const& pieces() const { return pieces_; }
    bool leaves(std::size_t arc, NodeId n) const { return from_[arc] == n; }

    /// The arc's line drawn away from one of its nodes.
    Line away_from(NodeId n, std::size_t arc) const {
        Line line = lines_[arc];
        if (!leaves(arc, n)) {
            std::ranges::reverse(line);
        }
        return line;
    }

    /// The arcs at a node, counter-clockwise.
    std::vector<std::size_t> around(NodeId n) const {
        std::vector<ArcId> arcs = in_[n];
        if (out_[n] != no_arc) {
            arcs.push_back(out_[n]);
        }
        Vec2 const centre = plan(nodes_[n]);
        auto const next = [&](std::size_t a) {
            return plan(leaves(a, n) ? lines_[a][1] : lines_[a][lines_[a].size() - 2]);
        };
        Vec2 const first = next(arcs.front());
        auto const half = [&](std::size_t a) { // of the turn that begins at the first
            int const side = geometry::side_of_line(centre, first, next(a));
            return side > 0 ? 1 : side < 0 ? 3 : 2;
        };
        std::sort(arcs.begin() + 1, arcs.end(), [&](std::size_t a, std::size_t b) {
            return half(a) != half(b) ? half(a) < half(b) : geometry::side_of_line(centre, next(a), next(b)) > 0;
        });
        return arcs;
    }

    /// Cuts the trunk, whose near part touches the node, and lets the tributary end between the parts.
    void shift(NodeId n, std::size_t trunk, std::size_t tributary, Shifted shifted) {
        bool const upstream = !leaves(trunk, n);
        ArcId const piece = lines_.size();
        NodeId const node = nodes_.size();
        nodes_.push_back(shifted.far.front());
        if (upstream) {
            std::ranges::reverse(shifted.near);
            std::ranges::reverse(shifted.far);
        }
        std::ranges::reverse(shifted.tributary);
        lines_[trunk] = std::move(shifted.far);
        lines_[tributary] = std::move(shifted.tributary);
        lines_.push_back(std::move(shifted.near));
        cut_off_.emplace_back();
        cut_off_[trunk].push_back(piece);
        std::erase(in_[n], tributary);
        to_[tributary] = node;
        if (upstream) {
            std::ranges::replace(in_[n], trunk, piece);
            to_[trunk] = node;
            from_.push_back(node);
            to_.push_back(n);
            in_.push_back({trunk, tributary});
            out_.push_back(piece);
        } else {
            out_[n] = piece;
            from_[trunk] = node;
            from_.push_back(n);
            to_.push_back(node);
            in_.push_back({tributary, piece});
            out_.push_back(trunk);
        }
        pieces_.push_back({trunk, tributary, upstream});
    }

    ElevatedNetwork raised(StreamNetwork const& old) const {
        ElevatedNetwork made;
        NetworkDraft drawn;
        for (Vec3 const at : nodes_) {
            drawn.add_node(plan(at));
            made.node_z.push_back(at.z);
        }
        for (std::size_t a = 0; a < lines_.size(); ++a) {
            std::size_t first = a; // the arc of which this is a piece of a piece
            while (first >= old.arc_count()) {
                first = pieces_[first - old.arc_count()].of;
            }
            Arc const& source = old.arc(first);
            Arc arc{{}, source.persistence, source.feature, source.type, source.is_input};
            std::vector<double> z;
            for (Vec3 const p : lines_[a]) {
                arc.line.push_back(plan(p));
                z.push_back(p.z);
            }
            drawn.add_arc(from_[a], to_[a], std::move(arc));
            made.arc_z.push_back(std::move(z));
        }
        made.plan = std::move(drawn);
        return made;
    }

private:
    std::vector<Vec3> nodes_;
    std::vector<Line> lines_;
    std::vector<NodeId> from_;
    std::vector<NodeId> to_;
    std::vector<std::vector<ArcId>> in_;
    std::vector<ArcId> out_;
    std::vector<std::vector<std::size_t>> cut_off_; ///< by arc: pieces of it
    std::vector<SplitPiece> pieces_;
};

/// Neighbours at a node of which one may be moved on to the other.
struct Pair {
    std::size_t trunk;
    std::size_t tributary;
    bool left;        ///< the tributary is the next one counter-clockwise
    double closeness; ///< cosine of the angle between them
};

double closeness(Line const& one, Line const& other) {
    Vec2 const a{one[1].x - one[0].x, one[1].y - one[0].y};
    Vec2 const b{other[1].x - other[0].x, other[1].y - other[0].y};
    return (a.x * b.x + a.y * b.y) / (distance({}, a) * distance({}, b));
}

/// The pairs at a node: those on the river that leaves it, or those among the rivers that end in it; the sharpest
/// angle first.
std::vector<Pair> pairs_at(Loose const& net, NodeId n, bool upstream) {
    std::vector<std::size_t> const around = net.around(n);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < around.size(); ++i) {
        std::size_t const a = around[i];
        std::size_t const b = around[(i + 1) % around.size()]; // counter-clockwise of a
        double const close = closeness(net.away_from(n, a), net.away_from(n, b));
        if (!net.leaves(b, n) && net.leaves(a, n) != upstream) {
            pairs.push_back({a, b, true, close});
        }
        if (!net.leaves(a, n) && net.leaves(b, n) != upstream) {
            pairs.push_back({b, a, false, close});
        }
    }
    std::ranges::stable_sort(pairs, std::ranges::greater{}, &Pair::closeness);
    return pairs;
}

class Splitter {
public:
    Splitter(Loose& net, SplitParams const& params, double distance_m)
        : net_(net), most_(static_cast<std::size_t>(params.max_upstream)), distance_m_(distance_m) {}

    /// Moves one tributary away from a node. near: the arcs near it, of the network as it was.
    bool split(NodeId n, std::vector<std::size_t> const& near) const {
        // Below it nodes would lie so close that a check takes them for ends that miss each other.
        double const fair_m = distance_m_ / 128.0;
        std::vector<std::size_t> arcs = near;
        for (std::size_t i = 0; i < arcs.size(); ++i) {
            auto const& pieces = net_.cut_off(arcs[i]);
            arcs.insert(arcs.end(), pieces.begin(), pieces.end());
        }
        return split(n, arcs, false, fair_m) || split(n, arcs, true, fair_m) || split(n, arcs, false, 0.0) ||
               split(n, arcs, true, 0.0);
    }

private:
    bool split(NodeId n, std::vector<std::size_t> const& arcs, bool upstream, double least_m) const {
        constexpr int enough = 48;    // halvings: by then a distance is below what coordinates can tell apart
        constexpr double wide = -0.5; // cosine of an angle at which a straight way would come close to the node
        std::vector<Pair> const pairs = pairs_at(net_, n, upstream);
        auto const to_move = static_cast<double>(net_.arcs_into(n) - most_);
        double share = 1.0;
        for (int halving = 0; halving < enough; ++halving, share /= 2.0) {
            for (Pair const& pair : pairs) {
                Neighbours at{
                    net_.away_from(n, pair.trunk), net_.away_from(n, pair.tributary), pair.left, !upstream, {}};
                for (std::size_t const a : arcs) {
                    if (a != pair.trunk && a != pair.tributary) {
                        at.others.push_back(&net_.line(a));
                    }
                }
                // The next one to be moved finds its place between this one and the node.
                double const along_m =
                    share * std::min(distance_m_ * to_move, length_in_plan(at.trunk) * to_move / (to_move + 1.0));
                if (along_m < least_m) {
                    continue;
                }
                Shifted shifted;
                bool const corner_first = pair.closeness < wide;
                if (shift_tributary(at, along_m, corner_first, shifted) ||
                    shift_tributary(at, along_m, !corner_first, shifted)) {
                    net_.shift(n, pair.trunk, pair.tributary, std::move(shifted));
                    return true;
                }
            }
        }
        return false;
    }

    Loose& net_;
    std::size_t most_;
    double distance_m_;
};

void require(SplitParams const& params, ElevatedNetwork const& network) {
    if (params.max_upstream < 2) {
        throw BadParameter(fmt::format("network.split_confluences: max_upstream is {}; a confluence joins at least 2",
                                       params.max_upstream));
    }
    require_in("network.split_confluences", "distance", params.distance_m, Range::at_least(0.0), "m");
    require_trees(network.plan, "network.split_confluences");
    bool whole = network.node_z.size() == network.plan.node_count() && network.arc_z.size() == network.plan.arc_count();
    for (std::size_t a = 0; whole && a < network.plan.arc_count(); ++a) {
        auto const& line = network.plan.arc(a).line;
        whole = network.arc_z[a].size() == line.size();
        if (auto const twice = std::ranges::adjacent_find(line); twice != line.end()) {
            throw BadInput(fmt::format("network.split_confluences: arc {} has the vertex ({}, {}) twice in a row; "
                                       "remove one",
                                       a + 1, twice->x, twice->y));
        }
    }
    if (!whole) {
        throw BadInput("network.split_confluences: the heights are not those of this network");
    }
}

} // namespace

Split split_confluences(ElevatedNetwork const& network, SplitParams const& params, Run const& run) {
    require(params, network);
    auto const most = static_cast<std::size_t>(params.max_upstream);
    std::vector<NodeId> crowded;
    std::vector<Vec2> places;
    std::size_t highest = most;
    for (NodeId n = 0; n < network.plan.node_count(); ++n) {
        if (network.plan.in(n).size() > most) {
            crowded.push_back(n);
            places.push_back(network.plan.node(n).at);
            highest = std::max(highest, network.plan.in(n).size());
        }
    }
    if (crowded.empty()) {
        return {network, {}};
    }
    double const distance_m = params.distance_m > 0.0 ? params.distance_m : median_segment(network.plan);
    std::vector<std::vector<Vec2>> lines;
    for (ArcId arc = 0; arc < network.plan.arc_count(); ++arc) {
        lines.push_back(network.plan.arc(arc).line);
    }
    // What is drawn anew lies within one reach of its node; what another node's splitting drew, within two.
    double const reach_m = distance_m * static_cast<double>(highest - most);
    auto const near = geometry::segments_near(places, lines, 2.25 * reach_m, run);
    Loose net(network);
    Splitter const splitter(net, params, distance_m);
    for (std::size_t i = 0; i < crowded.size(); ++i) {
        run.at(static_cast<double>(i) / static_cast<double>(crowded.size()), "split");
        std::vector<std::size_t> arcs;
        for (geometry::NearSegment const& segment : near[i]) {
            if (arcs.empty() || arcs.back() != segment.line) {
                arcs.push_back(segment.line);
            }
        }
        while (net.arcs_into(crowded[i]) > most) {
            if (!splitter.split(crowded[i], arcs)) {
                Vec3 const at = net.at(crowded[i]);
                throw BadInput(fmt::format("network.split_confluences: {} rivers meet at ({}, {}), and lines nearby "
                                           "leave no room to split them; draw them farther apart",
                                           net.arcs_into(crowded[i]), at.x, at.y));
            }
        }
    }
    return {net.raised(network.plan), net.pieces()};
}

} // namespace thalweg::network
