// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/drainage/internal/agreement.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace thalweg::measure {

namespace {

constexpr std::uint8_t far_away = 3;

/// Calls visit(index, ring) for the 5 x 5 cells around one, ring 0, 1 or 2.
template <class Visit> void around(std::int64_t centre, Grid const& grid, Visit visit) {
    Cell const at = grid.at(centre);
    for (std::int64_t dr = -2; dr <= 2; ++dr) {
        for (std::int64_t dc = -2; dc <= 2; ++dc) {
            if (Cell const c{at.col + dc, at.row + dr}; grid.contains(c)) {
                visit(grid.index(c), static_cast<std::size_t>(std::max(std::abs(dr), std::abs(dc))));
            }
        }
    }
}

/// By cell the ring of the nearest of some cells: 0, 1, 2 or far_away.
Raster<std::uint8_t> rings(std::vector<std::int64_t> const& cells, Grid const& grid) {
    Raster<std::uint8_t> near(grid, far_away);
    for (std::int64_t const i : cells) {
        around(i, grid,
               [&](std::int64_t n, std::size_t ring) { near[n] = std::min(near[n], static_cast<std::uint8_t>(ring)); });
    }
    return near;
}

using Counts = std::array<std::int64_t, 3>; ///< within 0, 1, 2 cells

double share(std::int64_t part, std::int64_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

Agreements of_counts(Counts const& hits, std::int64_t found, Counts const& met, std::int64_t rivers) {
    Agreements out;
    for (std::size_t k = 0; k < out.size(); ++k) {
        out[k] = {share(hits[k], found), share(met[k], rivers)};
    }
    return out;
}

Counts within(std::vector<std::int64_t> const& cells, std::vector<std::int64_t> const& of, Grid const& grid) {
    Raster<std::uint8_t> const near = rings(of, grid);
    Counts counts{};
    for (std::int64_t const i : cells) {
        for (std::size_t k = near[i]; k < counts.size(); ++k) {
            ++counts[k];
        }
    }
    return counts;
}

std::vector<std::int64_t> thresholds_to(std::int64_t most) {
    std::vector<std::int64_t> out;
    for (std::int64_t t = 16; t <= most; t *= 2) {
        out.push_back(t);
        if (t / 2 * 3 <= most) {
            out.push_back(t / 2 * 3);
        }
    }
    return out;
}

} // namespace

Agreements agreement(std::vector<std::int64_t> const& found, std::vector<std::int64_t> const& rivers,
                     Grid const& grid) {
    return of_counts(within(found, rivers, grid), static_cast<std::int64_t>(found.size()), within(rivers, found, grid),
                     static_cast<std::int64_t>(rivers.size()));
}

std::pair<std::int64_t, Agreements> best_threshold(Raster<std::int64_t> const& area_cells,
                                                   std::vector<std::int64_t> const& rivers, Run const& run) {
    auto const areas = area_cells.values();
    std::vector<std::int64_t> const thresholds =
        thresholds_to(areas.empty() ? 0 : *std::max_element(areas.begin(), areas.end()));
    if (thresholds.empty()) {
        return {0, {}};
    }
    // How many thresholds an area reaches; counted there, and added up from above.
    auto const reached = [&](std::int64_t area) {
        return static_cast<std::size_t>(std::upper_bound(thresholds.begin(), thresholds.end(), area) -
                                        thresholds.begin());
    };
    std::vector<std::int64_t> found(thresholds.size() + 1, 0);
    std::vector<Counts> hits(thresholds.size() + 1, Counts{});
    std::vector<Counts> met(thresholds.size() + 1, Counts{});
    Raster<std::uint8_t> const near = rings(rivers, area_cells.grid());
    for (std::int64_t i = 0; i < area_cells.cells(); ++i) {
        if (area_cells[i] >= thresholds.front()) {
            std::size_t const bin = reached(area_cells[i]);
            ++found[bin];
            for (std::size_t k = near[i]; k < 3; ++k) {
                ++hits[bin][k];
            }
        }
    }
    run.check();
    for (std::int64_t const i : rivers) {
        std::array<std::int64_t, 3> most{};
        around(i, area_cells.grid(), [&](std::int64_t n, std::size_t ring) {
            for (std::size_t k = ring; k < most.size(); ++k) {
                most[k] = std::max(most[k], area_cells[n]);
            }
        });
        for (std::size_t k = 0; k < most.size(); ++k) {
            ++met[reached(most[k])][k];
        }
    }
    std::pair<std::int64_t, Agreements> best{0, {}};
    std::int64_t found_here = 0;
    Counts hits_here{};
    Counts met_here{};
    for (std::size_t bin = thresholds.size(); bin > 0; --bin) {
        found_here += found[bin];
        for (std::size_t k = 0; k < hits_here.size(); ++k) {
            hits_here[k] += hits[bin][k];
            met_here[k] += met[bin][k];
        }
        Agreements const here = of_counts(hits_here, found_here, met_here, static_cast<std::int64_t>(rivers.size()));
        if (best.first == 0 || here[1].f() >= best.second[1].f()) {
            best = {thresholds[bin - 1], here};
        }
    }
    return best;
}

} // namespace thalweg::measure
