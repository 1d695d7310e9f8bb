// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/lakes.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>

// Described in docs/algorithms/lake_flooding.md.

namespace thalweg::network {
namespace {

// Calls visit(index) for the 8 neighbours of a cell.
template <class Visit> void each_neighbour(Grid const& grid, std::int64_t cell, Visit visit) {
    Cell const c = grid.at(cell);
    for (Cell const step : d8_steps) {
        if (Cell const n{c.col + step.col, c.row + step.row}; grid.contains(n)) {
            visit(grid.index(n));
        }
    }
}

// A lake before flooding.
struct Basin {
    std::int32_t label = 0;
    std::int64_t cut = 0; // number of cells removed from its label
    std::vector<std::int64_t> cells;
};

// Labels without cells on the grid's border or beside a smaller label. Throws BadInput for a label below 0.
Raster<std::int32_t> kept_apart(Raster<std::int32_t> const& labels) {
    Grid const& grid = labels.grid();
    Raster<std::int32_t> out = labels;
    for (std::int64_t i = 0; i < labels.cells(); ++i) {
        if (labels[i] < 0) {
            Vec2 const at = grid.centre(grid.at(i));
            throw BadInput(
                "network.flood_lakes",
                fmt::format("the label {} at ({:.3f}, {:.3f}) is below 0; number lakes from 1", labels[i], at.x, at.y));
        }
        if (labels[i] == 0) {
            continue;
        }
        bool gives_way = grid.on_border(grid.at(i));
        each_neighbour(grid, i, [&](std::int64_t n) { gives_way |= labels[n] > 0 && labels[n] < labels[i]; });
        out[i] = gives_way ? 0 : labels[i];
    }
    return out;
}

// The lakes of a raster of labels of which some cells remain, in the order of their first cells.
std::vector<Basin> basins_of(Raster<std::int32_t> const& labels, Raster<std::int32_t> left) {
    std::unordered_map<std::int32_t, std::int64_t> cut; // only looked up, never iterated
    for (std::int64_t i = 0; i < labels.cells(); ++i) {
        cut[labels[i]] += labels[i] != left[i] ? 1 : 0;
    }
    std::vector<Basin> out;
    for (std::int64_t i = 0; i < left.cells(); ++i) {
        std::int32_t const label = left[i];
        if (label == 0) {
            continue;
        }
        Basin& basin = out.emplace_back(Basin{label, std::exchange(cut[label], 0), {i}});
        left[i] = 0;
        for (std::size_t k = 0; k < basin.cells.size(); ++k) {
            each_neighbour(labels.grid(), basin.cells[k], [&](std::int64_t n) {
                if (left[n] == label) {
                    left[n] = 0;
                    basin.cells.push_back(n);
                }
            });
        }
    }
    return out;
}

constexpr std::uint64_t lake_stage = 0x6c616b65; // "lake"
constexpr std::int64_t fewest_lake_cells = 16;
constexpr std::int64_t lakes_apart = 3; // [cells]

void check(ChannelsOfArcs const& drawn, std::vector<double> const& area_m2, ChooseLakesParams const& params) {
    require_in("network.choose_lakes", "share", params.share, Range::between(0.0, 1.0));
    refuse_if<BadParameter>(!(params.min_area_cells >= 0.0) || params.max_cells < 4, "network.choose_lakes",
                            "min_area_cells is {} and max_cells {}; they must be at least 0 and 4",
                            params.min_area_cells, params.max_cells);
    refuse_if<BadInput>(area_m2.size() != drawn.of_arc.size(), "network.choose_lakes",
                        "{} areas for {} arcs; give those of this network", area_m2.size(), drawn.of_arc.size());
}

class Shores {
public:
    Shores(ChannelsOfArcs const& drawn, std::uint64_t seed)
        : labels(drawn.channels.grid, 0), drawn_(drawn), seed_(seed), is_taken_(drawn.channels.grid, 0) {}

    Raster<std::int32_t> labels;

    /// Grows a lake around a position on an arc; does nothing if other lakes are there.
    void grow(std::size_t arc, std::int64_t cells, double along) {
        Grid const& grid = labels.grid();
        auto const& way = drawn_.of_arc[arc];
        auto const at = static_cast<std::size_t>(along * static_cast<double>(way.size()));
        std::int64_t const first = drawn_.channels.cell[way[at]];
        std::unordered_set<std::int64_t> river; // only looked up, never iterated
        for (std::int64_t const i : way) {
            river.insert(drawn_.channels.cell[i]);
        }
        std::uint64_t const own_seed = random_word(seed_, lake_stage, arc);
        double const wave = std::max(3.0, 0.6 * std::sqrt(static_cast<double>(cells)));
        using Entry = std::pair<double, std::int64_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        std::unordered_set<std::int64_t> done; // only looked up, never iterated
        std::vector<std::int64_t> lake;
        queue.emplace(0.0, first);
        while (!queue.empty() && static_cast<std::int64_t>(lake.size()) < cells) {
            auto const [cost, cell] = queue.top();
            queue.pop();
            if (!is_free(cell) || !done.insert(cell).second) {
                continue;
            }
            lake.push_back(cell);
            for (std::size_t k = 0; k < d8_steps.size(); ++k) {
                Cell const c = grid.at(cell);
                Cell const n{c.col + d8_steps[k].col, c.row + d8_steps[k].row};
                if (!grid.contains(n) || done.contains(grid.index(n))) {
                    continue;
                }
                double const rough = 0.5 + 0.5 * value_noise(own_seed, n, wave);
                double const ease = river.contains(grid.index(n)) ? 0.2 : 1.0;
                queue.emplace(cost + ease * (0.15 + rough * rough) / d8_per_length[k], grid.index(n));
            }
        }
        if (static_cast<std::int64_t>(lake.size()) >= fewest_lake_cells) {
            take(rounded(lake));
        }
    }

private:
    bool is_free(std::int64_t cell) const {
        Grid const& grid = labels.grid();
        Cell const c = grid.at(cell);
        return is_taken_[cell] == 0 && c.col >= lakes_apart && c.row >= lakes_apart &&
               c.col < grid.width - lakes_apart && c.row < grid.height - lakes_apart;
    }

    /// Smooths the shore: each cell becomes what most of its neighbours are.
    std::vector<std::int64_t> rounded(std::vector<std::int64_t> const& lake) const {
        std::unordered_map<std::int64_t, int> count; // only looked up, never iterated
        std::vector<std::int64_t> near;
        for (std::int64_t const cell : lake) {
            auto const add = [&](std::int64_t n) {
                if (++count[n] == 1) {
                    near.push_back(n);
                }
            };
            add(cell);
            each_neighbour(labels.grid(), cell, add);
        }
        std::vector<std::int64_t> out;
        std::copy_if(near.begin(), near.end(), std::back_inserter(out),
                     [&](std::int64_t n) { return count[n] >= 5 && is_free(n); });
        return out;
    }

    void take(std::vector<std::int64_t> const& lake) {
        ++last_;
        Grid const& grid = labels.grid();
        for (std::int64_t const cell : lake) {
            labels[cell] = last_;
            cells_around(grid, grid.at(cell), lakes_apart, [&](Cell near) { is_taken_[near] = 1; });
        }
    }

    ChannelsOfArcs const& drawn_;
    std::uint64_t seed_;
    Mask is_taken_;
    std::int32_t last_ = 0;
};

constexpr std::int64_t no_cell = -1;
constexpr std::int64_t fewest_flooded_cells = 4;

/// Channel network while lakes are being inserted.
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
            cut += separate_from_rivers(basin, outlet);
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
        std::int64_t const lost = remove_dry_rivers(links, outlet);
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

    std::vector<CellIndex> cell;        ///< new ones at the end
    std::vector<ChannelId> receiver;    ///< new ones at the end
    std::vector<std::uint8_t> is_gone;  ///< new ones at the end
    std::vector<std::uint8_t> is_level; ///< new ones at the end
    std::vector<Lake> lakes;
    std::vector<Finding> notes;

private:
    struct Link {
        std::int64_t cell;
        std::int64_t towards; ///< cell
    };

    bool is_in(std::int64_t channel) const { return lake_[cell[channel]] != 0; }

    /// Whether the water of a channel cell enters the lake downstream of it.
    bool flows_into_lake(std::int64_t channel) const {
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
            if (i < 0 || (receiver[i] >= 0 && is_in(receiver[i])) || flows_into_lake(i)) {
                continue;
            }
            bool const more = best != no_cell && (above_[i] > above_[best] || (above_[i] == above_[best] && i < best));
            best = best == no_cell || more ? i : best;
        }
        return best;
    }

    /// Removes lake cells beside rivers that do not flow into the lake, until there are none: water would leave there.
    std::int64_t separate_from_rivers(Basin const& basin, std::int64_t outlet) {
        std::int64_t taken = 0;
        for (bool changed = true; changed;) {
            changed = false;
            std::unordered_map<std::int64_t, bool> passes; // only looked up, never iterated
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
                        known->second = !flows_into_lake(i);
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

    /// Whether all inflow of a channel cell comes from the lake, but not through its outlet: such a cell is removed.
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

    /// The lake's cells connected to its outlet, nearest first, each with the next cell on its path there.
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

    /// Removes rivers below the lake that its water no longer reaches: completely if they return to it, otherwise as
    /// far as they touch it.
    /// \return their number
    std::int64_t remove_dry_rivers(std::vector<Link> const& links, std::int64_t outlet) {
        for (Link const& link : links) {
            lake_[link.cell] = 1;
        }
        lake_[cell[outlet]] = 1;
        std::sort(left_.begin(), left_.end());
        left_.erase(std::unique(left_.begin(), left_.end()), left_.end());
        std::int64_t rivers = 0;
        for (std::int64_t i : left_) {
            rivers += is_in(i) ? 0 : 1;
            bool const returns = flows_into_lake(i);
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

    void note(FindingKind kind, Basin const& basin, double amount, std::string const& what) {
        Vec2 const at = grid_.centre(grid_.at(basin.cells.front()));
        notes.push_back({kind, basin.label, at, amount,
                         fmt::format("lake {} at ({:.3f}, {:.3f}): {}", basin.label, at.x, at.y, what)});
    }

    Run const& run_;
    Grid grid_;
    Raster<std::int32_t> number_; ///< by cell; -1: no channel
    Mask lake_;                   ///< the current lake
    /// by channel cell: number of channel cells upstream before there were lakes, itself included
    std::vector<std::int64_t> above_;
    std::vector<std::int64_t> donors_;
    std::vector<std::int64_t> left_; ///< cells into which the lake's water flowed
};

/// Old numbers, receivers before donors.
std::vector<std::int64_t> downstream_first(Lakes const& lakes) {
    std::vector<ChannelId> first(lakes.cell.size(), no_cell); // donor, and the next one of the same receiver
    std::vector<ChannelId> next(lakes.cell.size(), no_cell);
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

/// Lake cells beside a river that does not flow into their lake: its former receiver may now belong to another lake.
std::vector<std::int64_t> leaks(Lakes const& lakes, std::vector<std::int64_t> const& order, Grid const& grid) {
    std::vector<ChannelId> outlet(lakes.cell.size(), no_cell); // by level cell
    std::unordered_map<std::int64_t, std::int64_t> number;     // only looked up, never iterated
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

/// Sets lakes to their outlet's height and raises their inflows to it.
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
FloodedLakes with_lakes(ChannelsOfArcs const& drawn, Lakes lakes, std::vector<std::int64_t> const& order) {
    FloodedLakes out;
    std::vector<ChannelId> now(lakes.cell.size(), no_cell);
    Channels& channels = out.drawn.channels;
    channels.grid = drawn.channels.grid;
    for (std::int64_t const i : order) {
        now[i] = std::ssize(channels.cell);
        channels.cell.push_back(lakes.cell[i]);
        channels.receiver.push_back(lakes.receiver[i] < 0 ? no_cell : now[lakes.receiver[i]]);
        channels.level.push_back(lakes.is_level[i]);
        if (!drawn.channels.z.empty()) {
            bool const is_new = i >= std::ssize(drawn.channels.z);
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

/// What keeps the level of a lake up: the next lake with a level downstream, or the end of the river.
std::string hindrance(Channels const& channels, std::vector<Lake> const& lakes, Lake const& lake,
                      Raster<float> const& dem) {
    std::int64_t cells = 0;
    std::int64_t at = lake.outlet;
    do {
        if (channels.receiver[at] < 0) {
            return fmt::format("its river ends at {:.6g} m, cells downstream: {}", dem[channels.cell[at]], cells);
        }
        at = channels.receiver[at];
        ++cells;
    } while (std::isnan(channels.lake_z[at]));
    auto const below = std::ranges::find(lakes, at, &Lake::outlet);
    return fmt::format("lake {} stands at {:.6g} m, cells downstream: {}", below->label, dem[channels.cell[at]], cells);
}

} // namespace

Raster<std::int32_t> choose_lakes(ChannelsOfArcs const& drawn, std::vector<double> const& area_m2,
                                  ChooseLakesParams const& params, Run const& run) {
    check(drawn, area_m2, params);
    Grid const& grid = drawn.channels.grid;
    Shores shores(drawn, params.seed);
    for (std::size_t a = 0; a < area_m2.size(); ++a) {
        run.check();
        double const area = area_m2[a] / (grid.cell_m * grid.cell_m);
        auto const words = random_block(params.seed, lake_stage, ~0ULL, a);
        if (!(area >= params.min_area_cells) || drawn.of_arc[a].empty() || !(unit(words[0]) < params.share)) {
            continue;
        }
        auto const least = static_cast<double>(fewest_lake_cells);
        double const most = std::max(least, std::min(area / 50.0, static_cast<double>(params.max_cells)));
        // Small lakes are frequent, large ones rare: the logarithm is uniform.
        double const size = least * portable::pow(most / least, unit(words[1]));
        shores.grow(a, static_cast<std::int64_t>(size), 0.2 + 0.6 * unit(words[2]));
    }
    return std::move(shores.labels);
}

FloodedLakes flood_lakes(ChannelsOfArcs const& drawn, Raster<std::int32_t> const& labels, Run const& run) {
    require_same_grid(labels.grid(), drawn.channels.grid, "network.flood_lakes", "the lakes and the channels",
                      "draw both on one grid");
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
        for (std::int64_t const cell : leaking) { // terminates: the number of cells decreases
            kept[cell] = 0;
        }
    }
}

std::vector<Finding> lakes_off_levels(std::vector<Finding> const& lakes) {
    if (lakes.empty()) {
        return {};
    }
    Finding const& first = lakes.front();
    std::string const more =
        lakes.size() > 1 ? fmt::format(". Others that miss their levels: {}", lakes.size() - 1) : "";
    return {{.kind = "lakes_off_levels",
             .feature = first.feature,
             .where = first.where,
             .text = first.text + more,
             .key = "surface.lakes",
             .numbers = {{"lakes", static_cast<double>(lakes.size())}}}};
}

std::vector<Finding> missed_levels(Channels const& channels, std::vector<Lake> const& lakes, Raster<float> const& dem) {
    std::vector<Finding> notes;
    for (Lake const& lake : lakes) {
        float const wanted = channels.lake_z[lake.outlet];
        std::int64_t const cell = channels.cell[lake.outlet];
        if (std::isnan(wanted) || dem[cell] == wanted) {
            continue;
        }
        Vec2 const at = dem.grid().centre(dem.grid().at(cell));
        notes.push_back({"lake_level", lake.label, at, static_cast<double>(dem[cell]),
                         fmt::format("lake {} at ({:.3f}, {:.3f}) has the level {:.6g} m, not {:.6g} m: {}", lake.label,
                                     at.x, at.y, dem[cell], wanted, hindrance(channels, lakes, lake, dem))});
    }
    append(notes, lakes_off_levels(notes));
    return notes;
}

} // namespace thalweg::network
