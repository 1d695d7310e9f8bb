// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>

namespace thalweg::network {

namespace {

using Number = std::size_t; ///< of a cell of the skeleton
constexpr Number none = std::numeric_limits<Number>::max();

struct Neighbours {
    std::size_t count = 0;
    std::array<Number, 8> number{};
    std::array<std::uint8_t, 8> diagonal{};
};

/// The set cells, numbered in ascending order of their index, and their neighbours.
class SkeletonGraph {
public:
    explicit SkeletonGraph(Mask const& mask) : mask_(mask) {
        for (std::int64_t row = 0; row < mask.height(); ++row) {
            row_begin_.push_back(cells_.size());
            std::int64_t col = 0;
            for (std::uint8_t const value : mask.row(row)) {
                if (value != 0) {
                    cells_.push_back({col, row});
                }
                ++col;
            }
        }
        row_begin_.push_back(cells_.size());
    }

    std::size_t size() const { return cells_.size(); }
    Cell cell(Number number) const { return cells_[number]; }

    /// A diagonal neighbour counts only if neither orthogonal cell between is set.
    Neighbours neighbours(Number number) const {
        Neighbours found;
        Cell const c = cell(number);
        for (std::int64_t dr = -1; dr <= 1; ++dr) {
            for (std::int64_t dc = -1; dc <= 1; ++dc) {
                bool const diagonal = dr != 0 && dc != 0;
                if ((dr == 0 && dc == 0) || !set({c.col + dc, c.row + dr}) ||
                    (diagonal && (set({c.col + dc, c.row}) || set({c.col, c.row + dr})))) {
                    continue;
                }
                found.number[found.count] = number_of({c.col + dc, c.row + dr});
                found.diagonal[found.count] = diagonal ? 1 : 0;
                ++found.count;
            }
        }
        return found;
    }

private:
    bool set(Cell c) const { return mask_.grid().contains(c) && mask_[c] != 0; }
    Number number_of(Cell c) const {
        Number const first = row_begin_[c.row];
        auto const row = std::span(cells_).subspan(first, row_begin_[c.row + 1] - first);
        auto const before = [&](Cell a) { return a.col < c.col; };
        return first + static_cast<Number>(std::partition_point(row.begin(), row.end(), before) - row.begin());
    }

    Mask const& mask_;
    std::vector<Cell> cells_;
    std::vector<Number> row_begin_;
};

/// Distance to the outlet as numbers of both kinds of steps: equal distances compare equal, in any order of steps.
struct Steps {
    std::int64_t orthogonal = 0;
    std::int64_t diagonal = 0;
    double cells() const {
        constexpr double sqrt2 = 1.41421356237309504880;
        return static_cast<double>(orthogonal) + static_cast<double>(diagonal) * sqrt2;
    }
};

/// A position in cells from the north-west, rounded to 2^-16 of a cell: equal distances stay equal, however the
/// coordinates in metres are rounded.
Vec2 in_cells(Grid const& grid, Vec2 p) {
    auto const rounded = [](double cells) { return std::floor(cells * 65536.0 + 0.5) / 65536.0; };
    return {rounded((p.x - grid.west) / grid.cell_m), rounded((grid.north - p.y) / grid.cell_m)};
}

/// The cell nearest to the mouth [cells] in the component of cell `start`; marks the component as seen.
Number outlet_of(Number start, SkeletonGraph const& graph, Vec2 mouth, std::vector<std::uint8_t>& seen) {
    Number best = start;
    double best_distance = std::numeric_limits<double>::infinity();
    std::vector<Number> open{start};
    seen[start] = 1;
    while (!open.empty()) {
        Number const u = open.back();
        open.pop_back();
        Cell const c = graph.cell(u);
        double const d = distance({static_cast<double>(c.col) + 0.5, static_cast<double>(c.row) + 0.5}, mouth);
        if (d < best_distance || (d == best_distance && u < best)) {
            best = u;
            best_distance = d;
        }
        Neighbours const near = graph.neighbours(u);
        for (std::size_t k = 0; k < near.count; ++k) {
            if (std::uint8_t& mark = seen[near.number[k]]; mark == 0) {
                mark = 1;
                open.push_back(near.number[k]);
            }
        }
    }
    return best;
}

/// Sets the downstream cell of every cell that reaches the outlet (Dijkstra; of equal paths the lower cell).
void drain_to(Number outlet, SkeletonGraph const& graph, std::vector<Number>& downstream, std::vector<Steps>& steps,
              Run const& run) {
    using Entry = std::pair<double, Number>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    queue.emplace(0.0, outlet);
    downstream[outlet] = outlet;
    for (std::int64_t popped = 1; !queue.empty(); ++popped) {
        auto const [at, u] = queue.top();
        queue.pop();
        if (popped % 65536 == 0) {
            run.check();
        }
        Steps const here = steps[u];
        if (at > here.cells()) {
            continue;
        }
        Neighbours const near = graph.neighbours(u);
        for (std::size_t k = 0; k < near.count; ++k) {
            Number const v = near.number[k];
            Steps const there{here.orthogonal + 1 - near.diagonal[k], here.diagonal + near.diagonal[k]};
            Number& parent = downstream[v];
            Steps& known = steps[v];
            if (parent == none || there.cells() < known.cells()) {
                parent = u;
                known = there;
                queue.emplace(there.cells(), v);
            } else if (there.cells() == known.cells() && u < parent) {
                parent = u;
            }
        }
    }
}

} // namespace

StreamNetwork trace(Mask const& skeleton, TraceParams const& params, Run const& run) {
    Vec2 const asked = params.mouth;
    refuse_if<BadParameter>(!is_finite(asked), "network.trace",
                            "the mouth is not a finite position; give it in metres");
    SkeletonGraph const graph(skeleton);
    Grid const& grid = skeleton.grid();
    std::size_t const cells = graph.size();
    refuse_if<BadInput>(cells == 0, "network.trace",
                        "the skeleton is empty; grow a larger cluster or choose another branch");

    Vec2 const mouth = in_cells(grid, asked);
    std::vector<std::uint8_t> seen(cells, 0);
    std::vector<Number> downstream(cells, none);
    std::vector<Steps> steps(cells);
    for (Number i = 0; i < cells; ++i) {
        if (seen[i] == 0) {
            run.check();
            drain_to(outlet_of(i, graph, mouth, seen), graph, downstream, steps, run);
        }
    }

    std::vector<std::uint8_t> upstream(cells, 0);
    for (std::size_t i = 0; i < cells; ++i) {
        if (Number const down = downstream[i]; down != i) {
            ++upstream[down];
        }
    }
    NetworkDraft network;
    constexpr NodeId no_node = std::numeric_limits<NodeId>::max();
    std::vector<NodeId> node(cells, no_node);
    for (std::size_t i = 0; i < cells; ++i) {
        bool const outlet = downstream[i] == i;
        if (outlet ? upstream[i] > 0 : upstream[i] != 1) {
            Vec2 const at = grid.centre(graph.cell(i));
            node[i] = network.add_node(at);
        }
    }
    for (std::size_t i = 0; i < cells; ++i) {
        if (node[i] == no_node || downstream[i] == i) {
            continue;
        }
        Arc arc;
        arc.line.push_back(grid.centre(graph.cell(i)));
        Number at = i;
        do {
            at = downstream[at];
            arc.line.push_back(grid.centre(graph.cell(at)));
        } while (node[at] == no_node);
        network.add_arc(node[i], node[at], std::move(arc));
    }
    refuse_if<BadInput>(network.arcs.empty(), "network.trace",
                        "no two of the skeleton's {} cells are neighbours, there is nothing to trace; grow a larger "
                        "cluster or choose another branch",
                        cells);
    return network;
}

} // namespace thalweg::network
