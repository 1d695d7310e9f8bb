// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>
#include <thalweg/network/vectorise/internal/keep_arcs.hpp>

namespace thalweg::network {

namespace {

using Flags = std::vector<std::uint8_t>;
using ChannelFlags = std::vector<std::uint8_t>;

/// By channel cell: whether it is removed.
ChannelFlags flags_of(std::vector<std::int64_t> const& gone, Channels const& channels) {
    ChannelFlags is_gone(channels.cell.size(), 0);
    for (std::int64_t const i : gone) {
        refuse_if<BadInput>(i < 0 || i >= std::ssize(is_gone), "network.shorten", "cell {} of {} channel cells", i,
                            is_gone.size());
        is_gone[i] = 1;
    }
    for (std::size_t i = 0; i < is_gone.size(); ++i) {
        if (channels.receiver[i] >= 0 && is_gone[i] == 0 && is_gone[channels.receiver[i]] != 0) {
            Vec2 const at = channels.grid.centre(channels.grid.at(channels.cell[channels.receiver[i]]));
            throw BadInput("network.shorten", fmt::format("a river that stays flows into the cell at ({:.3f}, {:.3f}), "
                                                          "which is to go; let it go with all above it",
                                                          at.x, at.y));
        }
    }
    return is_gone;
}

/// The midpoint of a segment's part inside a cell; nothing: it does not pass through.
std::optional<Vec2> middle_in(Cell cell, Vec2 a, Vec2 b, Grid const& grid) {
    double begin = 0.0;
    double end = 1.0;
    Vec2 const centre = grid.centre(cell);
    auto const clip = [&](double from, double to, double middle) {
        if (from == to) {
            return;
        }
        double const t = (middle - 0.5 * grid.cell_m - from) / (to - from);
        double const u = (middle + 0.5 * grid.cell_m - from) / (to - from);
        begin = std::max(begin, std::min(t, u));
        end = std::min(end, std::max(t, u));
    };
    clip(a.x, b.x, centre.x);
    clip(a.y, b.y, centre.y);
    double const along = 0.5 * (begin + end);
    Vec2 const at{a.x + (b.x - a.x) * along, a.y + (b.y - a.y) * along};
    if (!(begin < end) || !(grid.cell_of(at) == cell) || at == b) {
        return {};
    }
    return at;
}

/// The rest of a line from its first position in a remaining cell after the removed ones; empty: only its end remains.
std::vector<Vec2> rest_of(std::vector<Vec2> const& line, Grid const& grid, Mask const& goes, Mask const& stays) {
    std::vector<Cell> const cells = cells_of_vertices(line, grid);
    std::size_t segment = 0; // of the last removed cell
    std::int64_t step = -1;
    for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
        walk_cells(cells[i], cells[i + 1], [&](Cell c, std::int64_t k, std::int64_t) {
            if (goes[c] != 0) {
                segment = i;
                step = k;
            }
        });
    }
    for (std::size_t i = segment; i + 1 < cells.size(); ++i) {
        std::vector<Vec2> rest;
        walk_cells(cells[i], cells[i + 1], [&](Cell c, std::int64_t k, std::int64_t n) {
            if (!rest.empty() || stays[c] == 0 || (i == segment && k <= step)) {
                return;
            }
            if (k == n) {
                rest = {line[i + 1]};
            } else if (auto const at = middle_in(c, line[i], line[i + 1], grid)) {
                rest = {*at, line[i + 1]};
            }
        });
        if (!rest.empty()) {
            rest.insert(rest.end(), line.begin() + static_cast<std::ptrdiff_t>(i) + 2, line.end());
            return rest.size() > 1 ? rest : std::vector<Vec2>{};
        }
    }
    return {};
}

/// The rest of a line from its point nearest to a position; empty: only its end remains.
std::vector<Vec2> rest_from_nearest(std::vector<Vec2> const& line, Vec2 place) {
    std::size_t segment = 0;
    Vec2 nearest = line.front();
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        Vec2 const way = line[i + 1] - line[i];
        Vec2 const to = place - line[i];
        double const square = way.x * way.x + way.y * way.y;
        double const along = square > 0.0 ? std::clamp((way.x * to.x + way.y * to.y) / square, 0.0, 1.0) : 0.0;
        Vec2 const at{line[i].x + along * way.x, line[i].y + along * way.y};
        if (distance(at, place) < distance(nearest, place)) {
            nearest = at;
            segment = i;
        }
    }
    std::vector<Vec2> rest{nearest};
    rest.insert(rest.end(), line.begin() + static_cast<std::ptrdiff_t>(segment) + 1, line.end());
    if (rest[0] == rest[1]) {
        rest.erase(rest.begin());
    }
    return rest.size() > 1 ? rest : std::vector<Vec2>{};
}

/// Marks or clears an arc's selected channel cells in a mask.
void mark(Mask& mask, Channels const& channels, std::vector<std::int64_t> const& numbers, ChannelFlags const& is_gone,
          std::uint8_t which, std::uint8_t value) {
    for (std::int64_t const i : numbers) {
        if (is_gone[i] == which) {
            mask[channels.cell[i]] = value;
        }
    }
}

/// The remaining channels, and the new numbers; -1: removed.
Channels left_of(Channels const& channels, ChannelFlags const& is_gone, std::vector<ChannelId>& now) {
    Channels out;
    out.grid = channels.grid;
    now.assign(is_gone.size(), -1);
    for (std::size_t i = 0; i < is_gone.size(); ++i) {
        if (is_gone[i] != 0) {
            continue;
        }
        now[i] = std::ssize(out.cell);
        out.cell.push_back(channels.cell[i]);
        out.receiver.push_back(channels.receiver[i] < 0 ? -1 : now[channels.receiver[i]]);
        if (!channels.z.empty()) {
            out.z.push_back(channels.z[i]);
        }
        if (!channels.level.empty()) {
            out.level.push_back(channels.level[i]);
        }
        if (!channels.lake_z.empty()) {
            out.lake_z.push_back(channels.lake_z[i]);
        }
    }
    return out;
}

/// The network during the removal of tips.
class Tips {
public:
    Tips(StreamNetwork const& network, ChannelsOfArcs const& drawn, ChannelFlags const& is_gone)
        : kept(network.arc_count(), 1), network_(network), draft_(network.draft()), drawn_(drawn), is_gone_(is_gone),
          goes_(drawn.channels.grid, 0), stays_(drawn.channels.grid, 0), has_water_(network.arc_count(), 0) {}

    Flags kept; ///< by arc
    std::vector<Finding> notes;

    /// Sources first: an arc without water upstream loses the removed cells at its beginning.
    void take_off() {
        for (auto n = network_.upstream_order().rbegin(); n != network_.upstream_order().rend(); ++n) {
            if (network_.out(*n) != no_arc) {
                visit(network_.out(*n));
            }
        }
    }

    NetworkDraft const& shortened() const { return draft_; }

private:
    /// Whether river cells flow into an arc's first cell; arcs without cells of their own are passed through.
    bool has_water_above(std::size_t a) const {
        auto const above = network_.in(network_.from(a));
        return std::any_of(above.begin(), above.end(), [&](ArcId b) { return has_water_[b] != 0; });
    }

    /// Whether the rivers upstream of an arc, and the cell of its upper node, are removed.
    bool is_cut_off(std::size_t a) const {
        Grid const& grid = drawn_.channels.grid;
        Cell const first = cells_of_vertices({draft_.arcs[a].arc.line.front()}, grid).front();
        return !network_.in(network_.from(a)).empty() &&
               grid.index(first) != drawn_.channels.cell[drawn_.of_arc[a].front()];
    }

    void leave_out_above(std::size_t a) {
        std::vector<std::size_t> open{a};
        while (!open.empty()) {
            auto const above = network_.in(network_.from(open.back()));
            open.pop_back();
            for (ArcId const b : above) {
                kept[b] = 0;
                open.push_back(b);
            }
        }
    }

    Vec2 centre_of(std::int64_t channel) const {
        Grid const& grid = drawn_.channels.grid;
        return grid.centre(grid.at(drawn_.channels.cell[channel]));
    }

    /// The line of an arc through cell centres, if it lies too far beside its cells.
    template <class Iterator> std::vector<Vec2> through_cells(Iterator first, Iterator last, Vec2 end) const {
        std::vector<Vec2> line;
        std::transform(first, last, std::back_inserter(line), [&](std::int64_t i) { return centre_of(i); });
        if (!(line.back() == end)) {
            line.push_back(end);
        }
        return line.size() > 1 ? line : std::vector<Vec2>{};
    }

    /// The first of an arc's cells that flows to the next one; those before belong to another river.
    auto first_own(std::size_t a) const {
        auto const& cells = drawn_.of_arc[a];
        return std::adjacent_find(cells.begin(), cells.end(), [&](std::int64_t i, std::int64_t next) {
            return drawn_.channels.receiver[i] == next;
        });
    }

    void visit(std::size_t a) {
        auto const& cells = drawn_.of_arc[a];
        bool const goes_on = has_water_above(a);
        auto const own = first_own(a);
        bool const is_dry =
            !cells.empty() && (is_gone_[cells.front()] != 0 || (own != cells.end() && is_gone_[*own] != 0));
        if (cells.empty() || goes_on || (!is_dry && !is_cut_off(a))) {
            has_water_[a] = goes_on || !cells.empty() ? 1 : 0;
            return;
        }
        leave_out_above(a);
        std::vector<Vec2>& line = draft_.arcs[a].arc.line;
        Vec2 const source = line.front();
        double const before_m = length_of(line);
        mark(goes_, drawn_.channels, cells, is_gone_, 1, 1);
        mark(stays_, drawn_.channels, cells, is_gone_, 0, 1);
        std::vector<Vec2> rest = rest_of(line, drawn_.channels.grid, goes_, stays_);
        auto const own_end = cells.end() - (network_.out(network_.to(a)) != no_arc ? 1 : 0);
        auto const stays =
            std::find_if(std::min(own, own_end), own_end, [&](std::int64_t i) { return is_gone_[i] == 0; });
        if (rest.empty() && stays != own_end) { // its cells lie beside the line
            rest = rest_from_nearest(line, centre_of(*stays));
            if (rest.empty() || distance(rest.front(), centre_of(*stays)) > 1.5 * drawn_.channels.grid.cell_m) {
                rest = through_cells(stays, own_end, line.back());
            }
        }
        mark(goes_, drawn_.channels, cells, is_gone_, 1, 0);
        mark(stays_, drawn_.channels, cells, is_gone_, 0, 0);
        Finding note{"shortened", network_.arc(a).feature, source, before_m, ""};
        note.feature = note.feature != 0 ? note.feature : static_cast<std::int64_t>(a) + 1;
        if (rest.empty()) {
            kept[a] = 0;
            note.text = fmt::format("arc {} from ({:.3f}, {:.3f}) was left out, {:.3f} m: it stood above its "
                                    "surroundings",
                                    a + 1, source.x, source.y, before_m);
        } else {
            has_water_[a] = 1;
            line = std::move(rest);
            draft_.nodes[network_.from(a)].at = line.front();
            note.amount = before_m - length_of(line);
            note.where = line.front();
            note.text = fmt::format("arc {} begins at ({:.3f}, {:.3f}), {:.3f} m farther down: its tip stood above its "
                                    "surroundings",
                                    a + 1, line.front().x, line.front().y, note.amount);
        }
        notes.push_back(std::move(note));
    }

    StreamNetwork const& network_;
    NetworkDraft draft_; ///< the shortened network so far
    ChannelsOfArcs const& drawn_;
    ChannelFlags const& is_gone_;
    Mask goes_;
    Mask stays_;
    Flags has_water_; ///< by arc, complete for arcs whose upstream arcs were processed
};

} // namespace

ShortenedChannels shorten(StreamNetwork const& network, ChannelsOfArcs const& drawn,
                          std::vector<std::int64_t> const& gone) {
    require_trees(network, "network.shorten");
    refuse_if<BadInput>(drawn.of_arc.size() != network.arc_count(), "network.shorten",
                        "channels of {} arcs for {}; draw this network", drawn.of_arc.size(), network.arc_count());
    ChannelFlags const is_gone = flags_of(gone, drawn.channels);
    Tips tips(network, drawn, is_gone);
    tips.take_off();

    StreamNetwork const shortened(tips.shortened());
    std::vector<std::int64_t> lengths;
    for (double const length_m : shortened.length_m()) {
        lengths.push_back(static_cast<std::int64_t>(std::floor(length_m * 1024.0)));
    }
    KeptArcs kept = keep_arcs(shortened, lengths, tips.kept, Merge::new_ones);
    ShortenedChannels out;
    out.network = std::move(kept.network);
    out.notes = std::move(tips.notes);
    std::vector<ChannelId> now;
    out.drawn.channels = left_of(drawn.channels, is_gone, now);
    out.drawn.notes = drawn.notes;
    for (std::vector<std::size_t> const& pieces : kept.pieces) {
        auto& cells = out.drawn.of_arc.emplace_back();
        for (std::size_t const piece : pieces) {
            for (std::int64_t const i : drawn.of_arc[piece]) {
                if (now[i] >= 0 && (cells.empty() || cells.back() != now[i])) {
                    cells.push_back(now[i]);
                }
            }
        }
    }
    return out;
}

} // namespace thalweg::network
