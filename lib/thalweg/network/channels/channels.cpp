// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/channels.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {

namespace {

bool is_diagonal(Cell a, Cell b) {
    return a.col != b.col && a.row != b.row;
}

bool are_neighbours(Cell a, Cell b) {
    return std::abs(a.col - b.col) <= 1 && std::abs(a.row - b.row) <= 1;
}

/// The cells of an arc, downstream, without detours that return to a cell or cross the arc's own diagonal.
std::vector<Cell> simple_path(std::vector<Cell> const& cells, Grid const& grid) {
    std::vector<Cell> way;
    std::unordered_map<std::int64_t, std::size_t> place; // only looked up, never iterated
    auto const cut_after = [&](std::size_t last) {
        while (way.size() > last + 1) {
            place.erase(grid.index(way.back()));
            way.pop_back();
        }
    };
    for (Cell const c : cells) {
        if (auto const been = place.find(grid.index(c)); been != place.end()) {
            cut_after(been->second);
            continue;
        }
        if (!way.empty() && is_diagonal(way.back(), c)) {
            auto const p = place.find(grid.index({way.back().col, c.row}));
            auto const q = place.find(grid.index({c.col, way.back().row}));
            if (p != place.end() && q != place.end() &&
                std::max(p->second, q->second) - std::min(p->second, q->second) == 1) {
                cut_after(std::min(p->second, q->second));
            }
        }
        place[grid.index(c)] = way.size();
        way.push_back(c);
    }
    return way;
}

/// The channels during drawing: downstream before upstream.
class Drawing {
public:
    explicit Drawing(Grid const& grid) : number_(grid, -1) {}

    std::int64_t number(Cell c) const { return number_[c]; }
    ChannelId size() const { return std::ssize(cell_); }
    std::int64_t receiver(std::int64_t i) const { return receiver_[i]; }
    std::int64_t donors(std::int64_t i) const { return donors_[i]; }
    bool is_gone(std::int64_t i) const { return gone_[i] != 0; }
    Cell at(std::int64_t i) const { return number_.grid().at(cell_[i]); }

    void add(Cell c, std::int64_t receiver) {
        refuse_if<BadInput>(size() >= std::numeric_limits<std::int32_t>::max(), "network.channels",
                            "rivers run through more than 2^31 cells; take larger ones");
        number_[c] = static_cast<std::int32_t>(size());
        cell_.push_back(number_.grid().index(c));
        receiver_.push_back(receiver);
        donors_.push_back(0);
        gone_.push_back(0);
        if (receiver >= 0) {
            ++donors_[receiver];
        }
    }
    void lead(std::int64_t i, std::int64_t to) {
        --donors_[receiver_[i]];
        ++donors_[to];
        receiver_[i] = to;
    }
    void leave_out(std::int64_t i) {
        gone_[i] = 1;
        number_[cell_[i]] = -1;
        if (std::int64_t const below = receiver_[i]; below >= 0) {
            --donors_[below];
        }
    }

    /// The downstream cell of the channel that a step from a to b would cross; -1: none.
    std::int64_t crossed(Cell a, Cell b) const {
        if (!is_diagonal(a, b)) {
            return -1;
        }
        std::int64_t const p = number_[Cell{a.col, b.row}];
        std::int64_t const q = number_[Cell{b.col, a.row}];
        if (p < 0 || q < 0) {
            return -1;
        }
        return receiver(p) == q ? q : receiver(q) == p ? p : -1;
    }

    /// New numbers without removed cells; -1: removed.
    std::vector<ChannelId> renumbered(Channels& out) const {
        std::vector<ChannelId> now(cell_.size(), -1);
        for (std::size_t i = 0; i < cell_.size(); ++i) {
            if (gone_[i] == 0) {
                now[i] = std::ssize(out.cell);
                out.cell.push_back(cell_[i]);
                out.receiver.push_back(receiver_[i] < 0 ? -1 : now[receiver_[i]]);
            }
        }
        return now;
    }

private:
    Raster<std::int32_t> number_; ///< by cell; -1: no channel
    std::vector<CellIndex> cell_;
    std::vector<ChannelId> receiver_; ///< less than the cell's own number
    std::vector<std::int64_t> donors_;
    std::vector<std::uint8_t> gone_;
};

/// The arcs by steps to their outlet, then number: a cell belongs to the first.
std::vector<std::size_t> downstream_first(StreamNetwork const& network) {
    std::vector<std::int64_t> steps(network.arc_count(), 0);
    std::vector<std::size_t> order;
    for (NodeId const n : network.upstream_order()) {
        if (ArcId const out = network.out(n); out != no_arc) {
            ArcId const below = network.out(network.to(out));
            steps[out] = below == no_arc ? 0 : steps[below] + 1;
            order.push_back(out);
        }
    }
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::tie(steps[a], a) < std::tie(steps[b], b); });
    return order;
}

/// Draws the arcs and records which arc drew which cell.
class Drawer {
public:
    Drawer(StreamNetwork const& network, Grid const& grid)
        : drawing(grid), way(network.arc_count()), network_(network), grid_(grid) {}

    Drawing drawing;
    std::vector<std::vector<Cell>> way; ///< by arc: its cells, downstream

    void draw(std::size_t a) {
        way[a] = simple_path(cells_along(network_.arc(a).line, grid_, fmt::format("arc {}", a + 1)), grid_);
        for (std::size_t i = way[a].size(); i-- > 0;) {
            if (drawing.number(way[a][i]) >= 0) {
                continue;
            }
            std::int64_t receiver = -1;
            if (i + 1 < way[a].size()) {
                std::int64_t const crossed = drawing.crossed(way[a][i], way[a][i + 1]);
                receiver = crossed >= 0 ? crossed : drawing.number(way[a][i + 1]);
                note_capture(a, i, receiver);
            }
            drawing.add(way[a][i], receiver);
            owner_.push_back(a);
        }
    }

    std::vector<Finding> notes() {
        std::stable_sort(notes_.begin(), notes_.end(), [](auto const& p, auto const& q) { return p.first < q.first; });
        std::vector<Finding> out;
        for (std::size_t k = 0; k < notes_.size(); ++k) {
            // Entries are sorted from upstream: the last found is the first place downstream.
            if (k + 1 == notes_.size() || notes_[k + 1].first != notes_[k].first) {
                out.push_back(std::move(notes_[k].second));
            }
        }
        return out;
    }

private:
    bool is_downstream(std::size_t of, std::size_t a) const {
        for (ArcId below = of; below != no_arc; below = network_.out(network_.to(below))) {
            if (below == a) {
                return true;
            }
        }
        return false;
    }

    void note_capture(std::size_t a, std::size_t i, std::int64_t receiver) {
        std::size_t const by = owner_[receiver];
        if (by == a || network_.to(by) == network_.to(a) || is_downstream(a, by)) {
            return;
        }
        Vec2 const where = grid_.centre(drawing.at(receiver));
        std::int64_t const feature = network_.arc(a).feature;
        notes_.emplace_back(
            a, Finding{"captured", feature != 0 ? feature : static_cast<std::int64_t>(a) + 1, where,
                       static_cast<double>(way[a].size() - 1 - i),
                       fmt::format("arc {} meets arc {} in the cells at ({:.3f}, {:.3f}), where neither ends: its "
                                   "water goes on in the other",
                                   a + 1, by + 1, where.x, where.y)});
    }

    StreamNetwork const& network_;
    Grid grid_;
    std::vector<ArcId> owner_; ///< by channel cell
    std::vector<std::pair<std::size_t, Finding>> notes_;
};

/// By channel cell: whether a river begins there. Paths that begin where rivers share cells begin there too, except
/// short ones, which are removed.
std::vector<std::uint8_t> sources(Drawer& drawer, StreamNetwork const& network, std::int64_t stub_cells) {
    Drawing& drawing = drawer.drawing;
    std::vector<std::uint8_t> begins(drawing.size(), 0);
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        if (network.in(network.from(a)).empty()) {
            begins[drawing.number(drawer.way[a].front())] = 1;
        }
    }
    for (std::int64_t i = drawing.size() - 1; i >= 0; --i) {
        if (begins[i] != 0 || drawing.is_gone(i) || drawing.donors(i) != 0) {
            continue;
        }
        std::vector<std::int64_t> stub{i};
        while (drawing.receiver(stub.back()) >= 0 && drawing.donors(drawing.receiver(stub.back())) == 1 &&
               begins[drawing.receiver(stub.back())] == 0) {
            stub.push_back(drawing.receiver(stub.back()));
        }
        if (static_cast<std::int64_t>(stub.size()) >= stub_cells) {
            begins[i] = 1;
            continue;
        }
        for (std::int64_t const cell : stub) {
            drawing.leave_out(cell);
        }
    }
    return begins;
}

/// The farthest of the next cells downstream that is a neighbour and can be reached without crossing a channel.
std::int64_t farthest_neighbour(Drawing const& drawing, std::int64_t i, std::int64_t look_cells) {
    Cell const here = drawing.at(i);
    std::int64_t best = drawing.receiver(i);
    std::int64_t ahead = best;
    for (std::int64_t k = 1; k < look_cells && ahead >= 0; ++k) {
        ahead = drawing.receiver(ahead);
        if (ahead >= 0 && are_neighbours(here, drawing.at(ahead)) && drawing.crossed(here, drawing.at(ahead)) < 0) {
            best = ahead;
        }
    }
    return best;
}

/// Takes shortcuts until there are none. Each brings a cell closer to its outlet, so the loop ends.
void take_short_cuts(Drawing& drawing, std::vector<std::uint8_t> const& begins, std::int64_t look_cells,
                     Run const& run) {
    for (bool changed = true; changed;) {
        run.check();
        changed = false;
        for (std::int64_t i = drawing.size() - 1; i >= 0; --i) { // donors before their receivers
            if (drawing.is_gone(i)) {
                continue;
            }
            if (drawing.donors(i) == 0 && begins[i] == 0) {
                drawing.leave_out(i);
                changed = true;
                continue;
            }
            if (std::int64_t const to = farthest_neighbour(drawing, i, look_cells); to != drawing.receiver(i)) {
                drawing.lead(i, to);
                changed = true;
            }
        }
    }
}

void check(ChannelsParams const& params) {
    require_in("network.channels", "look_cells", params.look_cells, Range::between(0, 64));
    require_in("network.channels", "stub_cells", params.stub_cells, Range::at_least(0));
}

} // namespace

ChannelsOfArcs channels(StreamNetwork const& network, Grid const& grid, ChannelsParams const& params, Run const& run) {
    check(params);
    require_trees(network, "network.channels");
    Drawer drawer(network, grid);
    for (std::size_t const a : downstream_first(network)) {
        run.check();
        drawer.draw(a);
    }
    std::vector<std::uint8_t> const begins = sources(drawer, network, params.stub_cells);
    take_short_cuts(drawer.drawing, begins, params.look_cells, run);

    ChannelsOfArcs out;
    out.channels.grid = grid;
    std::vector<ChannelId> const now = drawer.drawing.renumbered(out.channels);
    out.of_arc.resize(network.arc_count());
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        for (Cell const c : drawer.way[a]) {
            if (std::int64_t const i = drawer.drawing.number(c); i >= 0) {
                out.of_arc[a].push_back(now[i]);
            }
        }
    }
    out.notes = drawer.notes();
    return out;
}

} // namespace thalweg::network
