// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/flood_lakes.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/channels/internal/lake_basins.hpp>

namespace thalweg::network {

namespace {

constexpr std::int64_t no_cell = -1;
constexpr std::int64_t fewest_flooded_cells = 4;

/// Channels while lakes are laid into them.
class Lakes {
public:
    Lakes(ChannelsOfArcs const& drawn, Run const& run)
        : cell(drawn.channels.cell), receiver(drawn.channels.receiver), is_gone(cell.size(), 0),
          is_level(cell.size(), 0), run_(run), grid_(drawn.channels.grid), number_(grid_, -1), lake_(grid_, 0),
          above_(cell.size(), 1), donors_(cell.size(), 0) {
        for (std::size_t i = cell.size(); i-- > 0;) {
            number_[cell[i]] = static_cast<std::int32_t>(i);
            if (receiver[i] >= 0) {
                above_[receiver[i]] += above_[i];
                ++donors_[receiver[i]];
            }
        }
    }

    void flood(Basin const& basin) {
        run_.check();
        for (std::int64_t const c : basin.cells) {
            lake_[c] = 1;
        }
        std::int64_t cut = basin.cut;
        std::int64_t const outlet = outlet_of(basin);
        if (outlet != no_cell) {
            cut += keep_from_rivers(basin, outlet);
        }
        std::vector<Link> const links = outlet == no_cell ? std::vector<Link>{} : links_to(outlet);
        auto const size = static_cast<std::int64_t>(links.size());
        for (std::int64_t const c : basin.cells) {
            lake_[c] = 0;
        }
        if (size < fewest_flooded_cells) {
            note("lake_left_out", basin, static_cast<double>(basin.cells.size()),
                 outlet == no_cell ? "no river runs through it" : "too little of it lies where its water can leave");
            return;
        }
        lay(links);
        std::int64_t const lost = take_off_dry(links, outlet);
        lakes.push_back({basin.label, outlet, size});
        if (cut > 0) {
            note("lake_cut", basin, static_cast<double>(cut),
                 fmt::format("cells taken off it at the grid's edge, beside another lake or a river that passes by: {}",
                             cut));
        }
        if (lost > 0) {
            note("lake_outlets", basin, static_cast<double>(lost),
                 fmt::format("rivers that left it besides its one outlet: {}", lost));
        }
    }

    Indexed<ChannelId, CellIndex> cell;        ///< new ones at the end
    Indexed<ChannelId, ChannelId> receiver;    ///< likewise
    Indexed<ChannelId, std::uint8_t> is_gone;  ///< likewise
    Indexed<ChannelId, std::uint8_t> is_level; ///< likewise
    std::vector<Lake> lakes;
    std::vector<Finding> notes;

private:
    struct Link {
        std::int64_t cell;
        std::int64_t towards; ///< cell
    };

    bool is_in(std::int64_t channel) const { return lake_[cell[channel]] != 0; }

    /// Whether the water of a channel cell comes into the lake below it.
    bool comes_in(std::int64_t channel) const {
        for (std::int64_t i = receiver[channel]; i >= 0; i = receiver[i]) {
            if (is_in(i)) {
                return true;
            }
        }
        return false;
    }

    std::int64_t outlet_of(Basin const& basin) const {
        std::int64_t best = no_cell;
        for (std::int64_t const c : basin.cells) {
            std::int64_t const i = number_[c];
            if (i < 0 || (receiver[i] >= 0 && is_in(receiver[i])) || comes_in(i)) {
                continue;
            }
            bool const more = best != no_cell && (above_[i] > above_[best] || (above_[i] == above_[best] && i < best));
            best = best == no_cell || more ? i : best;
        }
        return best;
    }

    /// Takes cells beside rivers that do not flow into the lake off it, until there are none: water would leave there.
    std::int64_t keep_from_rivers(Basin const& basin, std::int64_t outlet) {
        std::int64_t taken = 0;
        for (bool changed = true; changed;) {
            changed = false;
            std::unordered_map<std::int64_t, bool> passes; // looked up only, never walked
            for (std::int64_t const c : basin.cells) {
                if (lake_[c] == 0 || c == cell[outlet]) {
                    continue;
                }
                bool leaks = false;
                each_neighbour(grid_, c, [&](std::int64_t n) {
                    std::int64_t const i = number_[n];
                    if (i < 0 || lake_[n] != 0 || leaks || is_dry_below(i, outlet)) {
                        return;
                    }
                    auto const [known, is_new] = passes.try_emplace(i, false);
                    if (is_new) {
                        known->second = !comes_in(i);
                    }
                    leaks = known->second;
                });
                if (leaks) {
                    lake_[c] = 0;
                    ++taken;
                    changed = true;
                }
            }
        }
        return taken;
    }

    /// Whether all that flows into a channel cell comes from the lake, not by its outlet: it will be taken off.
    bool is_dry_below(std::int64_t channel, std::int64_t outlet) const {
        if (receiver[outlet] == channel) {
            return false;
        }
        std::int64_t from_lake = 0;
        each_neighbour(grid_, cell[channel], [&](std::int64_t n) {
            std::int64_t const i = number_[n];
            from_lake += i >= 0 && lake_[n] != 0 && receiver[i] == channel ? 1 : 0;
        });
        return from_lake > 0 && from_lake == donors_[channel];
    }

    /// The cells of the lake that hang together with its outlet, nearest first, each with the next on its way there.
    std::vector<Link> links_to(std::int64_t outlet) {
        std::vector<Link> out;
        std::vector<std::int64_t> front{cell[outlet]};
        lake_[front.front()] = 0;
        for (std::size_t k = 0; k < front.size(); ++k) {
            each_neighbour(grid_, front[k], [&](std::int64_t n) {
                if (lake_[n] != 0) {
                    lake_[n] = 0;
                    front.push_back(n);
                    out.push_back({n, front[k]});
                }
            });
        }
        return out;
    }

    void lay(std::vector<Link> const& links) {
        for (Link const& link : links) {
            if (number_[link.cell] < 0) {
                number_[link.cell] = static_cast<std::int32_t>(cell.size());
                cell.push_back(link.cell);
                receiver.push_back(no_cell);
                is_gone.push_back(0);
                is_level.push_back(0);
                above_.push_back(1);
                donors_.push_back(0);
            }
        }
        left_.clear();
        for (Link const& link : links) {
            std::int64_t const i = number_[link.cell];
            std::int64_t const to = number_[link.towards];
            std::int64_t const before = receiver[i];
            is_level[i] = 1;
            receiver[i] = to;
            ++donors_[to];
            if (before >= 0) {
                --donors_[before];
                left_.push_back(before);
            }
        }
    }

    /// Rivers below the lake that its water no longer reaches: those that come back are left out, others as far as
    /// they touch it. Gives: how many there were.
    std::int64_t take_off_dry(std::vector<Link> const& links, std::int64_t outlet) {
        for (Link const& link : links) {
            lake_[link.cell] = 1;
        }
        lake_[cell[outlet]] = 1;
        std::sort(left_.begin(), left_.end());
        left_.erase(std::unique(left_.begin(), left_.end()), left_.end());
        std::int64_t rivers = 0;
        for (std::int64_t i : left_) {
            rivers += is_in(i) ? 0 : 1;
            bool const returns = comes_in(i);
            while (i >= 0 && !is_in(i) && donors_[i] == 0 && is_level[i] == 0 && (returns || touches(i))) {
                is_gone[i] = 1;
                number_[cell[i]] = -1;
                i = receiver[i];
                if (i >= 0) {
                    --donors_[i];
                }
            }
        }
        for (Link const& link : links) {
            lake_[link.cell] = 0;
        }
        lake_[cell[outlet]] = 0;
        return rivers;
    }

    bool touches(std::int64_t channel) const {
        bool any = false;
        each_neighbour(grid_, cell[channel], [&](std::int64_t n) { any |= lake_[n] != 0; });
        return any;
    }

    void note(char const* kind, Basin const& basin, double amount, std::string const& what) {
        Vec2 const at = grid_.centre(grid_.at(basin.cells.front()));
        notes.push_back({kind, basin.label, at, amount,
                         fmt::format("lake {} at ({:.3f}, {:.3f}): {}", basin.label, at.x, at.y, what)});
    }

    Run const& run_;
    Grid grid_;
    Raster<std::int32_t> number_;            ///< by cell, -1 where no channel is
    Mask lake_;                              ///< the lake that is being laid
    Indexed<ChannelId, std::int64_t> above_; ///< channel cells that flow into each, before there were lakes; itself too
    Indexed<ChannelId, std::int64_t> donors_;
    std::vector<std::int64_t> left_; ///< cells that the lake's water flowed into
};

/// Old numbers in an order in which receivers come first.
std::vector<std::int64_t> downstream_first(Lakes const& lakes) {
    Indexed<ChannelId, ChannelId> first(lakes.cell.size(), no_cell); // donor, and the next one of the same receiver
    Indexed<ChannelId, ChannelId> next(lakes.cell.size(), no_cell);
    std::vector<std::int64_t> order;
    for (std::size_t i = lakes.cell.size(); i-- > 0;) {
        if (lakes.is_gone[i] == 0 && lakes.receiver[i] >= 0) {
            next[i] = std::exchange(first[lakes.receiver[i]], static_cast<std::int64_t>(i));
        }
    }
    for (std::size_t i = 0; i < lakes.cell.size(); ++i) {
        if (lakes.is_gone[i] == 0 && lakes.receiver[i] < 0) {
            order.push_back(static_cast<std::int64_t>(i));
        }
    }
    for (std::size_t k = 0; k < order.size(); ++k) {
        for (std::int64_t i = first[order[k]]; i >= 0; i = next[i]) {
            order.push_back(i);
        }
    }
    return order;
}

/// Level cells beside a river that does not flow into their lake: what it ran into before may have become another's.
std::vector<std::int64_t> leaks(Lakes const& lakes, std::vector<std::int64_t> const& order, Grid const& grid) {
    Indexed<ChannelId, ChannelId> outlet(lakes.cell.size(), no_cell); // by level cell
    std::unordered_map<std::int64_t, std::int64_t> number;            // looked up only, never walked
    for (std::int64_t const i : order) {
        number[lakes.cell[i]] = i;
        if (lakes.is_level[i] != 0) {
            std::int64_t const to = lakes.receiver[i];
            outlet[i] = lakes.is_level[to] != 0 ? outlet[to] : to;
        }
    }
    auto const flows_into = [&](std::int64_t i, std::int64_t lake) {
        for (; i >= 0 && i != lake && outlet[i] != lake; i = lakes.receiver[i]) {
        }
        return i >= 0;
    };
    std::vector<std::int64_t> out;
    for (std::int64_t const i : order) {
        bool leaks = false;
        if (outlet[i] >= 0) {
            each_neighbour(grid, lakes.cell[i], [&](std::int64_t n) {
                auto const river = number.find(n);
                leaks |= river != number.end() && !flows_into(river->second, outlet[i]);
            });
        }
        if (leaks) {
            out.push_back(lakes.cell[i]);
        }
    }
    return out;
}

/// Lakes at their outlet's height, what flows into them no lower.
void raise_to_lakes(Channels& channels) {
    for (std::size_t i = 0; i < channels.z.size(); ++i) {
        if (channels.receiver[i] < 0) {
            continue;
        }
        float const below = channels.z[channels.receiver[i]];
        channels.z[i] = channels.level[i] != 0 || channels.z[i] < below ? below : channels.z[i];
    }
}

/// The channels with their lakes, in a new order.
Flooded with_lakes(ChannelsOfArcs const& drawn, Lakes lakes, std::vector<std::int64_t> const& order) {
    Flooded out;
    Indexed<ChannelId, ChannelId> now(lakes.cell.size(), no_cell);
    Channels& channels = out.drawn.channels;
    channels.grid = drawn.channels.grid;
    for (std::int64_t const i : order) {
        now[i] = channels.cell.count();
        channels.cell.push_back(lakes.cell[i]);
        channels.receiver.push_back(lakes.receiver[i] < 0 ? no_cell : now[lakes.receiver[i]]);
        channels.level.push_back(lakes.is_level[i]);
        if (!drawn.channels.z.empty()) {
            bool const is_new = i >= drawn.channels.z.count();
            channels.z.push_back(is_new ? std::numeric_limits<float>::quiet_NaN() : drawn.channels.z[i]);
        }
    }
    raise_to_lakes(channels);
    for (auto const& numbers : drawn.of_arc) {
        auto& cells = out.drawn.of_arc.emplace_back();
        for (std::int64_t const i : numbers) {
            if (now[i] >= 0) {
                cells.push_back(now[i]);
            }
        }
    }
    out.drawn.notes = drawn.notes;
    out.notes = std::move(lakes.notes);
    for (Lake lake : lakes.lakes) {
        lake.outlet = now[lake.outlet];
        out.lakes.push_back(lake);
    }
    return out;
}

} // namespace

Flooded flood_lakes(ChannelsOfArcs const& drawn, Raster<std::int32_t> const& labels, Run const& run) {
    if (labels.grid() != drawn.channels.grid) {
        throw BadInput("network.flood_lakes: the lakes are not on the grid of the channels; draw them on it");
    }
    Raster<std::int32_t> kept = kept_apart(labels);
    for (;;) {
        Lakes lakes(drawn, run);
        for (Basin const& basin : basins_of(labels, kept)) {
            lakes.flood(basin);
        }
        std::vector<std::int64_t> const order = downstream_first(lakes);
        std::vector<std::int64_t> const leaking = leaks(lakes, order, labels.grid());
        if (leaking.empty()) {
            return with_lakes(drawn, std::move(lakes), order);
        }
        for (std::int64_t const cell : leaking) { // there are ever fewer cells
            kept[cell] = 0;
        }
    }
}

} // namespace thalweg::network
