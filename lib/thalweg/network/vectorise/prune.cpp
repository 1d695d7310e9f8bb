// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/prune.hpp>

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>
#include <thalweg/network/vectorise/internal/keep_arcs.hpp>

namespace thalweg::network {
namespace {

/// Lengths are whole multiples of 2^-24 cells per segment: the sum of the pieces then equals the length of the merged
/// arc in any order, and repeated pruning finds the same lengths. A step between cells is exactly one cell, however
/// coordinates are rounded.
constexpr double units_per_cell = 0x1p24;

std::vector<std::int64_t> lengths_in_units(StreamNetwork const& network, double cell_m) {
    double total_m = 0.0;
    for (double const length_m : network.length_m()) {
        total_m += length_m;
    }
    refuse_if<BadParameter>(!(total_m / cell_m < 0x1p36), "network.prune",
                            "the rivers are {} m long, too long for cells of {} m; give the cell in metres", total_m,
                            cell_m);
    std::vector<std::int64_t> units;
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        std::vector<Vec2> const& line = network.arc(arc).line;
        std::int64_t sum = 0;
        for (std::size_t i = 1; i < line.size(); ++i) {
            double const cells = distance(line[i - 1], line[i]) / cell_m;
            sum += static_cast<std::int64_t>(std::floor(cells * units_per_cell + 0.5));
        }
        units.push_back(sum);
    }
    return units;
}

/// The remaining network during the removal of leaves. A reach is a maximal chain of the network's arcs, its pieces;
/// its number is that of its most upstream piece.
class Remains {
public:
    Remains(StreamNetwork const& network, std::vector<std::int64_t> units)
        : units_(std::move(units)), source_(network.from()), mouth_(network.to()), arriving_(network.node_count(), 0),
          arriving_xor_(network.node_count(), 0), gone_(units_.size(), 0), next_piece_(units_.size(), no_arc),
          last_piece_(units_.size()) {
        for (ArcId a = 0; a < units_.size(); ++a) {
            last_piece_[a] = a;
            ++arriving_[mouth_[a]];
            arriving_xor_[mouth_[a]] ^= a;
        }
        for (NodeId n = 0; n < arriving_.size(); ++n) {
            leaving_.push_back(network.out(n));
        }
        for (NodeId n = 0; n < arriving_.size(); ++n) {
            merge_at(n);
        }
    }

    std::size_t arcs() const { return units_.size(); }
    std::int64_t units(ArcId reach) const { return units_[reach]; }
    NodeId source(ArcId reach) const { return source_[reach]; }
    /// Whether a reach still exists and has no river upstream.
    bool is_leaf(ArcId reach) const { return gone_[reach] == 0 && arriving_[source_[reach]] == 0; }

    /// Removes a leaf.
    /// \return the reach merged at its confluence, or no_arc
    ArcId remove(ArcId leaf) {
        NodeId const at = mouth_[leaf];
        gone_[leaf] = 1;
        --arriving_[at];
        arriving_xor_[at] ^= leaf;
        return merge_at(at);
    }
    template <class F> void each_piece(ArcId reach, F f) const {
        for (ArcId piece = reach; piece != no_arc; piece = next_piece_[piece]) {
            f(piece);
        }
    }

private:
    ArcId merge_at(NodeId node) {
        if (arriving_[node] != 1 || leaving_[node] == no_arc) {
            return no_arc;
        }
        ArcId const up = arriving_xor_[node];
        ArcId const down = leaving_[node];
        units_[up] += units_[down];
        next_piece_[last_piece_[up]] = down;
        last_piece_[up] = last_piece_[down];
        mouth_[up] = mouth_[down];
        arriving_xor_[mouth_[up]] ^= up ^ down;
        leaving_[source_[up]] = up;
        gone_[down] = 1;
        return up;
    }

    std::vector<std::int64_t> units_;
    std::vector<NodeId> source_;
    std::vector<NodeId> mouth_;
    std::vector<std::int64_t> arriving_; ///< by node: number of reaches that end there
    std::vector<ArcId> arriving_xor_;    ///< by node: XOR of their numbers, which gives the last one left
    std::vector<ArcId> leaving_;         ///< by node: the reach that leaves it, or a piece of it; no_arc: an outlet
    std::vector<std::uint8_t> gone_;
    std::vector<ArcId> next_piece_;
    std::vector<ArcId> last_piece_;
};

/// A leaf in order of removal: shortest first, of equals the northernmost source, then the westernmost.
struct Leaf {
    std::int64_t units;
    double minus_y;
    double x;
    ArcId reach;
    auto operator<=>(Leaf const&) const = default;
};

/// The largest L in units at which each arc is kept: the running maximum of the removed lengths.
std::vector<std::int64_t> survival(StreamNetwork const& network, Remains remains, Run const& run) {
    std::priority_queue<Leaf, std::vector<Leaf>, std::greater<>> queue;
    auto const push = [&](ArcId reach) {
        Vec2 const at = network.node(remains.source(reach)).at;
        queue.push({remains.units(reach), -at.y, at.x, reach});
    };
    for (ArcId a = 0; a < remains.arcs(); ++a) {
        if (remains.is_leaf(a)) {
            push(a);
        }
    }
    std::vector<std::int64_t> persistence(remains.arcs(), 0);
    std::int64_t longest = 0;
    for (std::int64_t popped = 1; !queue.empty(); ++popped) {
        if (popped % 65536 == 0) {
            run.check();
        }
        Leaf const leaf = queue.top();
        queue.pop();
        if (!remains.is_leaf(leaf.reach) || leaf.units != remains.units(leaf.reach)) {
            continue;
        }
        longest = std::max(longest, leaf.units);
        remains.each_piece(leaf.reach, [&](ArcId piece) { persistence[piece] = longest; });
        if (ArcId const merged = remains.remove(leaf.reach); merged != no_arc && remains.is_leaf(merged)) {
            push(merged);
        }
    }
    return persistence;
}

/// The least whole number of units not shorter than L. An L computed as cells times cell_m, perhaps half an ulp too
/// long, gives these cells.
std::int64_t least_units(PruneParams const& params) {
    constexpr double but_for_rounding = 1.0 - 0x1p-50;
    constexpr double most = 0x1p62;
    double const units = params.length_m / params.cell_m * units_per_cell * but_for_rounding;
    return static_cast<std::int64_t>(std::ceil(std::min(units, most)));
}

/// A number, at most x, that a reader can copy.
std::string readable_floor(double x) {
    double const hundredths = std::floor(x * 100.0) / 100.0;
    return hundredths > 0.0 ? fmt::format("{}", hundredths) : fmt::format("{}", x);
}

constexpr double of_cell = 1e-6; // centres of cells far from the origin are rounded

bool is_one(double step, double cell_m) {
    return std::fabs(std::fabs(step) - cell_m) <= of_cell * cell_m;
}

bool is_none(double step, double cell_m) {
    return std::fabs(step) <= of_cell * cell_m;
}

bool is_corner(Vec2 a, Vec2 b, Vec2 c, double cell_m) {
    bool const across = is_one(b.x - a.x, cell_m) && is_none(b.y - a.y, cell_m) && is_none(c.x - b.x, cell_m) &&
                        is_one(c.y - b.y, cell_m);
    bool const along = is_none(b.x - a.x, cell_m) && is_one(b.y - a.y, cell_m) && is_one(c.x - b.x, cell_m) &&
                       is_none(c.y - b.y, cell_m);
    return across || along;
}

} // namespace

PrunedNetwork prune(StreamNetwork const& network, PruneParams const& params, Run const& run) {
    require_in("network.prune", "length", params.length_m, Range::at_least(0.0), "m");
    require_in("network.prune", "cell", params.cell_m, Range::above(0.0), "m");
    require_trees(network, "network.prune");
    refuse_if<BadInput>(network.arc_count() == 0, "network.prune",
                        "the network has no arcs; trace or read some rivers first");

    std::vector<std::int64_t> const units = lengths_in_units(network, params.cell_m);
    std::vector<std::int64_t> const persistence = survival(network, Remains(network, units), run);

    PrunedNetwork pruned;
    pruned.arcs_before = static_cast<std::int64_t>(network.arc_count());
    NetworkDraft with_thresholds = network.draft();
    std::vector<std::uint8_t> kept;
    std::int64_t const least = least_units(params);
    for (ArcId a = 0; a < with_thresholds.arcs.size(); ++a) {
        with_thresholds.arcs[a].arc.persistence = static_cast<double>(persistence[a]) / units_per_cell;
        kept.push_back(persistence[a] >= least ? 1 : 0);
    }
    if (std::find(kept.begin(), kept.end(), 1) == kept.end()) {
        auto const longest = *std::max_element(persistence.begin(), persistence.end());
        std::string const most = readable_floor(static_cast<double>(longest) / units_per_cell);
        throw BadParameter(
            "network.prune",
            fmt::format("pruning at {:.12g} cells removes every arc (the longest is {}). Try {} or less.",
                        params.length_m / params.cell_m, most, most));
    }
    // L = 0 leaves a network unchanged, with the nodes between its features.
    pruned.network =
        least > 0 ? keep_arcs(std::move(with_thresholds), units, kept).network : std::move(with_thresholds);
    return pruned;
}

KeptArcs keep_arcs(StreamNetwork const& network, std::vector<std::int64_t> const& lengths,
                   std::vector<std::uint8_t> const& kept, Merge merge) {
    std::vector<std::int64_t> arriving(network.node_count(), 0);
    for (std::size_t a = 0; a < kept.size(); ++a) {
        arriving[network.to(a)] += kept[a];
    }
    auto const leaves = [&](NodeId n) { return network.out(n) != no_arc && kept[network.out(n)] != 0; };

    auto const is_merged = [&](NodeId n) {
        return arriving[n] == 1 && leaves(n) && (merge == Merge::all || network.in(n).size() > 1);
    };

    KeptArcs out;
    std::vector<NodeId> node(network.node_count(), 0);
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if ((leaves(n) || arriving[n] > 0) && !is_merged(n)) {
            node[n] = out.network.add_node(network.node(n).at);
        }
    }
    for (std::size_t a = 0; a < kept.size(); ++a) {
        if (kept[a] == 0 || is_merged(network.from(a))) {
            continue;
        }
        Arc arc = network.arc(a);
        std::size_t piece = a;
        std::size_t longest = a;
        std::vector<std::size_t>& pieces = out.pieces.emplace_back(1, a);
        while (is_merged(network.to(piece))) {
            piece = network.out(network.to(piece));
            pieces.push_back(piece);
            std::vector<Vec2> const& line = network.arc(piece).line;
            arc.line.insert(arc.line.end(), line.begin() + 1, line.end());
            longest = lengths[piece] > lengths[longest] ? piece : longest;
        }
        arc.feature = network.arc(longest).feature;
        arc.type = network.arc(longest).type;
        arc.is_input = network.arc(longest).is_input;
        out.network.add_arc(node[network.from(a)], node[network.to(piece)], std::move(arc));
    }
    return out;
}

StreamNetwork cut_corners(StreamNetwork const& network, double cell_m, Run const& run) {
    require_in("network.cut_corners", "cell", cell_m, Range::above(0.0), "m");
    NetworkDraft shorter = network.draft();
    for (DraftArc& drawn : shorter.arcs) {
        run.check();
        std::vector<Vec2>& line = drawn.arc.line;
        std::vector<Vec2> cut;
        for (std::size_t i = 0; i < line.size(); ++i) {
            bool const inner = !cut.empty() && i + 1 < line.size();
            if (!inner || !is_corner(cut.back(), line[i], line[i + 1], cell_m)) {
                cut.push_back(line[i]);
            }
        }
        line = std::move(cut);
    }
    return shorter;
}

} // namespace thalweg::network
