// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/split_confluences.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/triangles.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {
namespace {

using Line = std::vector<Vec3>;

// Two lines that begin at one point and are neighbours there, with the lines near them.
struct TrunkAndTributary {
    Line trunk;                      // drawn away from the point
    Line tributary;                  // drawn away from the point
    bool left;                       // the tributary is the next one counterclockwise; otherwise clockwise
    bool falls;                      // heights decrease along the trunk as drawn
    std::vector<Line const*> others; // every other line nearby, including those that end at the point
};

// The two lines after the tributary was led to a node on the trunk, all drawn as before.
struct ShiftedLines {
    Line near;      // the trunk's beginning, up to the node
    Line far;       // the rest of the trunk, from the node
    Line tributary; // from the node
};

/// A position on a line: the last vertex before it, the position itself, the first vertex after it.
struct PlaceOnLine {
    std::size_t before;
    Vec3 at;
    std::size_t after;
};

/// The position at a distance along a line, at a vertex if one is close enough.
std::optional<PlaceOnLine> place_at(Line const& line, double distance_m) {
    constexpr double as_good = 1e-6;
    double along = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        double const step = distance(in_plan(line[i - 1]), in_plan(line[i]));
        if (i + 1 < line.size() && std::fabs(along + step - distance_m) <= as_good * distance_m) {
            return PlaceOnLine{i - 1, line[i], i + 1};
        }
        if (along + step > distance_m) {
            double const share = (distance_m - along) / step;
            Vec3 const a = line[i - 1];
            Vec3 const b = line[i];
            auto const between = [&](double from, double to) {
                return std::clamp(from + share * (to - from), std::min(from, to), std::max(from, to));
            };
            return PlaceOnLine{i - 1, {between(a.x, b.x), between(a.y, b.y), between(a.z, b.z)}, i};
        }
        along += step;
    }
    return std::nullopt;
}

Vec2 direction(Vec3 from, Vec3 to) {
    double const length = distance(in_plan(from), in_plan(to));
    return {(to.x - from.x) / length, (to.y - from.y) / length};
}

/// A corner between the directions in which two neighbours leave a point, on the side without other lines.
Vec3 corner(Vec3 point, Vec2 trunk, Vec2 tributary, bool left, double distance_m, double z) {
    double const turn = left ? 1.0 : -1.0;
    // Normals of both into the free wedge: their mean bisects it, at any width.
    Vec2 const mean{turn * (tributary.y - trunk.y), turn * (trunk.x - tributary.x)};
    double const length = distance({}, mean);
    return {point.x + mean.x / length * distance_m, point.y + mean.y / length * distance_m, z};
}

struct Box {
    Vec2 low;
    Vec2 high;
};

Box box_of(std::vector<std::vector<Vec2>> const& lines) {
    Box box{lines[0][0], lines[0][0]};
    for (auto const& line : lines) {
        for (Vec2 const p : line) {
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
        }
    }
    return box;
}

void add_segments(Line const& line, Box const& box, std::vector<std::vector<Vec2>>& lines) {
    for (std::size_t i = 1; i < line.size(); ++i) {
        Vec3 const a = line[i - 1];
        Vec3 const b = line[i];
        bool const apart = std::max(a.x, b.x) < box.low.x || std::min(a.x, b.x) > box.high.x ||
                           std::max(a.y, b.y) < box.low.y || std::min(a.y, b.y) > box.high.y;
        if (!apart) {
            lines.push_back({in_plan(a), in_plan(b)});
        }
    }
}

/// Whether the new lines (from the tributary's own line to the node, and the trunk's segment on either side of the
/// node) meet nothing but their continuations.
bool is_free(std::array<std::vector<Vec2>, 3> const& drawn, std::vector<Line const*> const& rest) {
    std::vector<std::vector<Vec2>> lines(drawn.begin(), drawn.end());
    Box const box = box_of(lines);
    for (Line const* const line : rest) {
        add_segments(*line, box, lines);
    }
    Vec2 const node = drawn[0].back();
    return std::ranges::all_of(geometry::crossings(lines), [&](geometry::Crossing const& c) {
        return c.line < drawn.size() ? c.at == drawn[c.line].front() || c.at == drawn[c.line].back() : c.at != node;
    });
}

// Leads a tributary to a node on the trunk at a distance [m] along it: straight or around a corner, after leaving its
// own line at the same distance from the point, or half-way if it is shorter. Returns false if the new lines would meet
// something else or have length 0. Heights are between those of the ends; the node takes the lower of the trunk's and
// the tributary's.
bool shift_tributary(TrunkAndTributary const& at, double distance_m, bool round_a_corner, ShiftedLines& shifted) {
    double const leaving_m = std::min(distance_m, length_in_plan(at.tributary) / 2.0);
    auto node = place_at(at.trunk, distance_m);
    auto const leaving = place_at(at.tributary, leaving_m);
    if (!node || !leaving) {
        return false;
    }
    auto const offset = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
    Vec3 const point = at.trunk.front();
    node->at.z = std::min(node->at.z, leaving->at.z);
    shifted.near.assign(at.trunk.begin(), at.trunk.begin() + offset(node->before + 1));
    if (!at.falls) {
        for (Vec3& p : shifted.near) {
            p.z = std::min(p.z, node->at.z);
        }
    }
    shifted.near.push_back(node->at);
    shifted.far.assign(1, node->at);
    shifted.far.insert(shifted.far.end(), at.trunk.begin() + offset(node->after), at.trunk.end());
    shifted.tributary.assign(1, node->at);
    if (round_a_corner) {
        shifted.tributary.push_back(corner(point, direction(point, at.trunk[1]), direction(point, at.tributary[1]),
                                           at.left, leaving_m / 2.0, leaving->at.z));
    }
    std::size_t const way = shifted.tributary.size() + 2;
    shifted.tributary.push_back(leaving->at);
    shifted.tributary.insert(shifted.tributary.end(), at.tributary.begin() + offset(leaving->after),
                             at.tributary.end());

    std::array<std::vector<Vec2>, 3> drawn;
    for (std::size_t i = way; i-- > 0;) {
        drawn[0].push_back(in_plan(shifted.tributary[i]));
    }
    drawn[1] = {in_plan(at.trunk[node->before]), in_plan(node->at)};
    drawn[2] = {in_plan(node->at), in_plan(at.trunk[node->after])};
    for (auto const& line : drawn) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            if (!(distance(line[i - 1], line[i]) > 0.0)) { // also if squares underflow
                return false;
            }
        }
    }
    std::array<Line, 3> const kept{Line(at.trunk.begin(), at.trunk.begin() + offset(node->before + 1)),
                                   Line(at.trunk.begin() + offset(node->after), at.trunk.end()),
                                   Line(at.tributary.begin() + offset(leaving->after), at.tributary.end())};
    std::vector<Line const*> rest = at.others;
    for (Line const& line : kept) {
        rest.push_back(&line);
    }
    return is_free(drawn, rest);
}

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

/// A network whose arcs can be cut and redirected.
class Loose {
public:
    explicit Loose(ElevatedNetwork const& network) {
        for (NodeId n = 0; n < network.planform.node_count(); ++n) {
            in_.emplace_back(network.planform.in(n).begin(), network.planform.in(n).end());
            out_.push_back(network.planform.out(n));
            Vec2 const at = network.planform.node(n).at;
            nodes_.push_back({at.x, at.y, network.node_z[n]});
        }
        for (std::size_t a = 0; a < network.planform.arc_count(); ++a) {
            Line line;
            for (std::size_t i = 0; Vec2 const p : network.planform.arc(a).line) {
                line.push_back({p.x, p.y, network.arc_z[a][i++]});
            }
            lines_.push_back(std::move(line));
            from_.push_back(network.planform.from(a));
            to_.push_back(network.planform.to(a));
            cut_off_.emplace_back();
        }
    }

    std::size_t arcs_into(NodeId n) const { return in_[n].size(); }
    Vec3 at(NodeId n) const { return nodes_[n]; }
    Line const& line(std::size_t arc) const { return lines_[arc]; }
    std::vector<std::size_t> const& cut_off(std::size_t arc) const { return cut_off_[arc]; }
    std::vector<SplitPiece> const& pieces() const { return pieces_; }
    bool leaves(std::size_t arc, NodeId n) const { return from_[arc] == n; }

    /// The arc's line, drawn away from one of its nodes.
    Line away_from(NodeId n, std::size_t arc) const {
        Line line = lines_[arc];
        if (!leaves(arc, n)) {
            std::ranges::reverse(line);
        }
        return line;
    }

    /// The arcs at a node, counterclockwise.
    std::vector<std::size_t> around(NodeId n) const {
        std::vector<ArcId> arcs = in_[n];
        if (out_[n] != no_arc) {
            arcs.push_back(out_[n]);
        }
        Vec2 const centre = in_plan(nodes_[n]);
        auto const next = [&](std::size_t a) {
            return in_plan(leaves(a, n) ? lines_[a][1] : lines_[a][lines_[a].size() - 2]);
        };
        Vec2 const first = next(arcs.front());
        auto const half = [&](std::size_t a) { // half of the turn that begins at the first
            int const side = geometry::side_of_line(centre, first, next(a));
            return side > 0 ? 1 : side < 0 ? 3 : 2;
        };
        std::sort(arcs.begin() + 1, arcs.end(), [&](std::size_t a, std::size_t b) {
            return half(a) != half(b) ? half(a) < half(b) : geometry::side_of_line(centre, next(a), next(b)) > 0;
        });
        return arcs;
    }

    /// Splits the trunk, whose near part touches the node, and ends the tributary between the parts.
    void shift(NodeId n, std::size_t trunk, std::size_t tributary, ShiftedLines shifted) {
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
            drawn.add_node(in_plan(at));
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
                arc.line.push_back(in_plan(p));
                z.push_back(p.z);
            }
            drawn.add_arc(from_[a], to_[a], std::move(arc));
            made.arc_z.push_back(std::move(z));
        }
        made.planform = std::move(drawn);
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

double closeness(Line const& one, Line const& other) {
    Vec2 const a{one[1].x - one[0].x, one[1].y - one[0].y};
    Vec2 const b{other[1].x - other[0].x, other[1].y - other[0].y};
    return (a.x * b.x + a.y * b.y) / (distance({}, a) * distance({}, b));
}

/// Neighbours at a node, one of which may be moved onto the other.
struct Pair {
    std::size_t trunk;
    std::size_t tributary;
    bool left;        ///< the tributary is the next one counterclockwise
    double closeness; ///< cosine of the angle between them
};

/// The pairs at a node: those on the river that leaves it, or those among the rivers that end in it; the sharpest angle
/// first.
std::vector<Pair> pairs_at(Loose const& net, NodeId n, bool upstream) {
    std::vector<std::size_t> const around = net.around(n);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < around.size(); ++i) {
        std::size_t const a = around[i];
        std::size_t const b = around[(i + 1) % around.size()]; // counterclockwise of a
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

    /// Moves one tributary away from a node. near: the arcs near it in the original network.
    bool split(NodeId n, std::vector<std::size_t> const& near) const {
        // At smaller distances a check would take nodes for ends that miss each other.
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
        constexpr int enough = 48;    // halvings: the distance is then below the precision of coordinates
        constexpr double wide = -0.5; // cosine of an angle at which a straight line would come close to the node
        std::vector<Pair> const pairs = pairs_at(net_, n, upstream);
        auto const to_move = static_cast<double>(net_.arcs_into(n) - most_);
        double share = 1.0;
        for (int halving = 0; halving < enough; ++halving, share /= 2.0) {
            for (Pair const& pair : pairs) {
                TrunkAndTributary at{
                    net_.away_from(n, pair.trunk), net_.away_from(n, pair.tributary), pair.left, !upstream, {}};
                for (std::size_t const a : arcs) {
                    if (a != pair.trunk && a != pair.tributary) {
                        at.others.push_back(&net_.line(a));
                    }
                }
                // The next tributary is placed between this one and the node.
                double const along_m =
                    share * std::min(distance_m_ * to_move, length_in_plan(at.trunk) * to_move / (to_move + 1.0));
                if (along_m < least_m) {
                    continue;
                }
                ShiftedLines shifted;
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
    refuse_if<BadParameter>(params.max_upstream < 2, "network.split_confluences",
                            "max_upstream is {}; a confluence joins at least 2", params.max_upstream);
    require_in("network.split_confluences", "distance", params.distance_m, Range::at_least(0.0), "m");
    require_trees(network.planform, "network.split_confluences");
    bool whole =
        network.node_z.size() == network.planform.node_count() && network.arc_z.size() == network.planform.arc_count();
    for (std::size_t a = 0; whole && a < network.planform.arc_count(); ++a) {
        auto const& line = network.planform.arc(a).line;
        whole = network.arc_z[a].size() == line.size();
        if (auto const twice = std::ranges::adjacent_find(line); twice != line.end()) {
            throw BadInput(
                "network.split_confluences",
                fmt::format("arc {} has the vertex ({}, {}) twice in a row; remove one", a + 1, twice->x, twice->y));
        }
    }
    refuse_if<BadInput>(!whole, "network.split_confluences", "the heights are not those of this network");
}

} // namespace

Split split_confluences(ElevatedNetwork const& network, SplitParams const& params, Run const& run) {
    require(params, network);
    auto const most = static_cast<std::size_t>(params.max_upstream);
    std::vector<NodeId> crowded;
    std::vector<Vec2> places;
    std::size_t highest = most;
    for (NodeId n = 0; n < network.planform.node_count(); ++n) {
        if (network.planform.in(n).size() > most) {
            crowded.push_back(n);
            places.push_back(network.planform.node(n).at);
            highest = std::max(highest, network.planform.in(n).size());
        }
    }
    if (crowded.empty()) {
        return {network, {}};
    }
    double const distance_m = params.distance_m > 0.0 ? params.distance_m : median_segment(network.planform);
    std::vector<std::vector<Vec2>> lines;
    for (ArcId arc = 0; arc < network.planform.arc_count(); ++arc) {
        lines.push_back(network.planform.arc(arc).line);
    }
    // New lines lie within one reach of their node; those of another node's splitting within two.
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
                throw BadInput("network.split_confluences",
                               fmt::format("{} rivers meet at ({}, {}), and lines nearby leave no room to split them; "
                                           "draw them farther apart",
                                           net.arcs_into(crowded[i]), at.x, at.y));
            }
        }
    }
    return {net.raised(network.planform), net.pieces()};
}

} // namespace thalweg::network
