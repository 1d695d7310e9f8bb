// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/catchments.hpp>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/internal/row_bands.hpp>

namespace thalweg::flow {
namespace {

constexpr std::int32_t nowhere = -1;

void require_countable(std::size_t count, char const* what) {
    refuse_if<BadInput>(std::cmp_greater(count, std::numeric_limits<std::int32_t>::max()), "flow.catchments",
                        "{} {}, 2^31 or more", count, what);
}

/// By position in cells (ascending by index): counts the grid cells nearest to it by city-block distance, ties to the
/// lower position. A key holds the distance above the position, so that the smaller key wins; a step adds one to the
/// distance and keeps that order, which makes the sweeps along rows and columns exact.
std::vector<std::int64_t> count_nearest(std::vector<RiverCell> const& cells, Grid const& grid, Run const& run) {
    using Key = std::uint64_t;
    constexpr Key step = Key{1} << 32U;
    constexpr Key nothing = Key{1} << 62U;
    constexpr std::int64_t most = std::int64_t{1} << 30U; // limit of either half of a key
    refuse_if<BadInput>(grid.width + grid.height > most || static_cast<std::int64_t>(cells.size()) > most,
                        "flow.areas_nearest", "{} x {} cells with {} river cells are beyond 2^30 of either", grid.width,
                        grid.height, cells.size());
    auto const width = static_cast<std::size_t>(grid.width);
    Raster<Key> keys(grid, nothing);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        keys[cells[i].cell] = i;
    }
    for (std::int64_t r = 0; r < grid.height; ++r) {
        run.check();
        auto const row = keys.row(r);
        for (std::size_t c = 1; c < width; ++c) {
            row[c] = std::min(row[c], row[c - 1] + step);
        }
        for (std::size_t c = width - 1; c > 0; --c) {
            row[c - 1] = std::min(row[c - 1], row[c] + step);
        }
        for (std::size_t c = 0; r > 0 && c < width; ++c) {
            row[c] = std::min(row[c], keys.row(r - 1)[c] + step);
        }
    }
    std::vector<std::int64_t> count(cells.size(), 0);
    for (std::int64_t r = grid.height - 1; r >= 0; --r) {
        run.check();
        auto const row = keys.row(r);
        for (std::size_t c = 0; c < width; ++c) {
            if (r + 1 < grid.height) {
                row[c] = std::min(row[c], keys.row(r + 1)[c] + step);
            }
            ++count[row[c] % step];
        }
    }
    return count;
}

/// By position in cells: counts the grid cells whose D8 flow path reaches it before any other river cell.
std::vector<std::int64_t> count_draining(std::vector<RiverCell> const& cells, FlowField const& drainage,
                                         Run const& run) {
    std::vector<std::int64_t> count(cells.size(), 0);
    Raster<std::int32_t> const met = first_met(cells, drainage, run);
    for (std::int32_t const place : met.values()) {
        if (place >= 0) {
            ++count[place];
        }
    }
    return count;
}

/// Accumulates the cells' own areas down the rivers.
ContributingAreas accumulate(StreamNetwork const& network, std::vector<RiverCell> const& cells,
                             std::vector<std::int64_t> const& count, Grid const& grid, char const* source) {
    std::vector<double> const arcs(network.arc_count(), 0.0);
    ContributingAreas areas{arcs, arcs, std::vector<double>(network.node_count(), 0.0), source};
    std::vector<std::int64_t> at_start(network.arc_count(), 0); // the share of the arc's first cell
    std::vector<std::int64_t> beyond(network.arc_count(), 0);   // that of its other cells
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::size_t const a = cells[i].reach;
        Cell const start = cells_of_vertices({network.node(network.from(a)).at}, grid).front();
        (cells[i].cell == grid.index(start) ? at_start : beyond)[a] += count[i];
    }
    std::vector<std::int64_t> through(network.node_count(), 0); // by node, in cells
    double const cell_m2 = grid.cell_m * grid.cell_m;
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) {
        if (network.out(*n) != no_arc) {
            auto const a = network.out(*n);
            through[*n] += at_start[a];
            std::int64_t const end = through[*n] + beyond[a];
            through[network.to(a)] += end;
            areas.us_area_m2[a] = static_cast<double>(through[*n]) * cell_m2;
            areas.ds_area_m2[a] = static_cast<double>(end) * cell_m2;
        }
        areas.node_m2[*n] = static_cast<double>(through[*n]) * cell_m2;
    }
    return areas;
}

constexpr std::int32_t unknown = -2; ///< beside numbers of cells and nowhere

/// Follows paths inside a band until a known cell. Where one leaves the band, its cells get the number of that exit.
/// \return by exit: the cell of another band where the path goes on
std::vector<std::int64_t> follow_in(RowBand const& band, Raster<std::int32_t>& to, FlowField const& drainage,
                                    Run const& run) {
    std::vector<std::int64_t> exits;
    std::vector<std::int64_t> way;
    for (std::int64_t i = band.begin; i < band.end; ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        way.clear();
        std::int64_t at = i;
        while (to[at] == unknown) {
            way.push_back(at);
            std::int64_t const next = drainage.receiver(at);
            if (next < 0) {
                to[at] = nowhere;
            } else if (band.contains(next)) {
                at = next;
            } else {
                exits.push_back(next);
                to[at] = unknown - static_cast<std::int32_t>(exits.size());
            }
        }
        std::int32_t const met = to[at];
        for (std::int64_t const cell : way) {
            to[cell] = met;
        }
    }
    return exits;
}

std::size_t exit_of(std::int32_t number) {
    return static_cast<std::size_t>(unknown - 1 - number);
}

/// By band and exit: what the path meets beyond it.
std::vector<std::vector<std::int32_t>> met_beyond(std::vector<std::vector<std::int64_t>> const& exits,
                                                  Raster<std::int32_t> const& to, RowBands const& bands) {
    std::vector<std::vector<std::int32_t>> met;
    for (auto const& of_band : exits) {
        met.emplace_back(of_band.size(), unknown);
    }
    std::vector<std::pair<std::size_t, std::size_t>> way;
    for (std::size_t band = 0; band < exits.size(); ++band) {
        for (std::size_t exit = 0; exit < exits[band].size(); ++exit) {
            std::pair at{band, exit};
            std::int32_t end = met[band][exit];
            while (end == unknown) {
                way.push_back(at);
                std::int64_t const next = exits[at.first][at.second];
                end = to[next];
                if (end < unknown) {
                    at = {bands.band_of(next), exit_of(end)};
                    end = met[at.first][at.second];
                }
            }
            for (auto const& [b, e] : way) {
                met[b][e] = end;
            }
            way.clear();
        }
    }
    return met;
}

/// Follows the path from each unknown cell to a known one, or to its end.
void follow_to_known(Raster<std::int32_t>& to, FlowField const& drainage, Run const& run) {
    RowBands const bands(to.grid(), run);
    std::vector<std::vector<std::int64_t>> exits(bands.count());
    bands.each(run, [&](RowBand const& band) { exits[band.number] = follow_in(band, to, drainage, run); });
    auto const met = met_beyond(exits, to, bands);
    bands.each(run, [&](RowBand const& band) {
        for (std::int64_t i = band.begin; !met[band.number].empty() && i < band.end; ++i) {
            to[i] = to[i] < unknown ? met[band.number][exit_of(to[i])] : to[i];
        }
    });
}

} // namespace

Reaches reaches_of(StreamNetwork const& network) {
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if (network.out_arcs(n).size() > 1) {
            throw BadInput("flow.reaches_of",
                           fmt::format("{} arcs leave node {} at ({}, {}); a river must not split",
                                       network.out_arcs(n).size(), n + 1, network.node(n).at.x, network.node(n).at.y));
        }
    }
    Reaches reaches;
    reaches.reserve(network.arc_count());
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        ArcId const below = network.out(network.to(a));
        reaches.push_back({{network.arc(a).line},
                           below == no_arc ? -1 : static_cast<std::int64_t>(below),
                           static_cast<std::int64_t>(a) + 1});
    }
    return reaches;
}

std::vector<std::int64_t> steps_to_outlet(Reaches const& reaches) {
    constexpr std::int64_t unknown = 0;
    constexpr std::int64_t on_the_way = -1;
    std::vector<std::int64_t> steps(reaches.size(), unknown);
    std::vector<ReachId> way;
    for (ReachId start = 0; start < std::ssize(reaches); ++start) {
        way.clear();
        std::int64_t below = 0;
        for (ReachId at = start; steps[at] <= 0;) {
            if (steps[at] == on_the_way) {
                throw BadInput(
                    "flow.steps_to_outlet",
                    fmt::format("arc {} leads to no outlet: its rivers run in a circle; see what thalweg check says",
                                reaches[at].id));
            }
            steps[at] = on_the_way;
            way.push_back(at);
            if (reaches[at].ds < 0) {
                break;
            }
            ReachId const next = reaches[at].ds;
            if (next >= std::ssize(reaches)) {
                throw BadInput("flow.steps_to_outlet",
                               fmt::format("arc {} runs into reach {} of {}", reaches[at].id, next, reaches.size()));
            }
            at = next;
            below = std::max<std::int64_t>(steps[at], 0);
        }
        for (auto at = way.rbegin(); at != way.rend(); ++at) {
            steps[*at] = ++below;
        }
    }
    return steps;
}

std::vector<RiverCell> river_cells(Reaches const& reaches, Grid const& grid, Run const& run) {
    auto const steps = steps_to_outlet(reaches);
    std::vector<RiverCell> cells;
    for (std::size_t a = 0; a < reaches.size(); ++a) {
        run.check();
        for (auto const& line : reaches[a].lines) {
            for (Cell const c : cells_along(line, grid, fmt::format("arc {}", reaches[a].id))) {
                cells.push_back({grid.index(c), a});
            }
        }
    }
    std::sort(cells.begin(), cells.end(), [&](RiverCell const& p, RiverCell const& q) {
        return std::tie(p.cell, steps[p.reach], p.reach) < std::tie(q.cell, steps[q.reach], q.reach);
    });
    cells.erase(std::unique(cells.begin(), cells.end(),
                            [](RiverCell const& p, RiverCell const& q) { return p.cell == q.cell; }),
                cells.end());
    return cells;
}

Raster<std::int32_t> first_met(std::vector<RiverCell> const& cells, FlowField const& drainage, Run const& run) {
    require_countable(cells.size(), "river cells");
    Grid const& grid = drainage.direction.grid();
    Raster<std::int32_t> to(grid, unknown);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i].cell < 0 || cells[i].cell >= grid.cells()) {
            throw BadInput("flow.first_met", "cell " + std::to_string(cells[i].cell) + " is none of the flow field's " +
                                                 std::to_string(grid.cells()));
        }
        if (drainage.direction[cells[i].cell] != Direction::no_data) {
            to[cells[i].cell] = static_cast<std::int32_t>(i);
        }
    }
    follow_to_known(to, drainage, run);
    return to;
}

Catchments catchments(Reaches const& reaches, FlowField const& drainage, Run const& run) {
    require_countable(reaches.size(), "reaches");
    auto const steps = steps_to_outlet(reaches);
    std::vector<RiverCell> const cells = river_cells(reaches, drainage.direction.grid(), run);
    Catchments result{first_met(cells, drainage, run), std::vector<std::int64_t>(reaches.size(), 0), {}, 0};
    for (std::int64_t i = 0; i < result.reach.cells(); ++i) {
        if (std::int32_t& place = result.reach[i]; place >= 0) {
            std::size_t const reach = cells[place].reach;
            ++result.cells[reach];
            place = static_cast<std::int32_t>(reach);
        } else {
            result.without += drainage.direction[i] == Direction::no_data ? 0 : 1;
        }
    }
    result.upstream = result.cells;
    std::vector<std::size_t> downstream_order(reaches.size());
    std::iota(downstream_order.begin(), downstream_order.end(), std::size_t{0});
    std::stable_sort(downstream_order.begin(), downstream_order.end(),
                     [&](std::size_t a, std::size_t b) { return steps[a] > steps[b]; });
    for (std::size_t const a : downstream_order) {
        if (reaches[a].ds >= 0) {
            result.upstream[reaches[a].ds] += result.upstream[a];
        }
    }
    return result;
}

ContributingAreas areas_nearest(StreamNetwork const& network, Grid const& grid, Run const& run) {
    auto const cells = river_cells(reaches_of(network), grid, run);
    auto const count = cells.empty() ? std::vector<std::int64_t>{} : count_nearest(cells, grid, run);
    return accumulate(network, cells, count, grid, "nearest");
}

ContributingAreas areas_d8(StreamNetwork const& network, FlowField const& drainage, Run const& run) {
    Grid const& grid = drainage.direction.grid();
    auto const cells = river_cells(reaches_of(network), grid, run);
    return accumulate(network, cells, count_draining(cells, drainage, run), grid, "d8");
}

} // namespace thalweg::flow
