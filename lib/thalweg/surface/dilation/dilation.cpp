// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/dilation/dilation.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/surface/dilation/separable.hpp>

namespace thalweg::surface {
namespace {

// \throws BadInput when the grid has no cells or its cell size is not above 0.
void check_frame(Grid const& grid) {
    refuse_if<BadInput>(grid.cells() <= 0, "surface.dilate", "the valley's grid has no cells; make it at least 1 x 1");
    refuse_if<BadInput>(!(grid.cell_m > 0.0 && std::isfinite(grid.cell_m)), "surface.dilate",
                        "the valley's cell size is {} m; give one above 0", grid.cell_m);
}

// \throws BadInput when no cell of the valley has a height, or one is infinite.
void check_heights(Raster<float> const& valley) {
    Grid const& grid = valley.grid();
    bool wet = false;
    for (std::int64_t i = 0; i < valley.cells(); ++i) {
        if (std::isinf(valley[i])) {
            Cell const cell = grid.at(i);
            throw BadInput(
                "surface.dilate",
                fmt::format("infinite height in the valley at column {}, row {}; every river needs finite heights",
                            cell.col, cell.row));
        }
        wet = wet || !std::isnan(valley[i]);
    }
    refuse_if<BadInput>(!wet, "surface.dilate",
                        "no cell of the valley has a height on the grid of {} x {} cells (inside the mask, where there "
                        "is one); let a river run there",
                        grid.width, grid.height);
}

// \throws BadInput when the mask has another frame than the valley.
void check_mask(Grid const& valley, Grid const& mask) {
    refuse_if<BadInput>(valley != mask, "surface.dilate",
                        "the mask ({} x {} cells of {} m) has another frame than the valley ({} x {} cells of {} m); "
                        "make both on one grid",
                        mask.width, mask.height, mask.cell_m, valley.width, valley.height, valley.cell_m);
}

// Computes the share [0, 1] of the cells off the valley that have no lower 4-neighbour; 0 if there are none.
double flat_share(Valley const& valley, Raster<float> const& dem, Run const& run) {
    std::int64_t const width = dem.width();
    std::int64_t const height = dem.height();
    std::atomic<std::int64_t> dry = 0;
    std::atomic<std::int64_t> flat = 0;
    parallel_ranges(run, height, 64, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t row = first; row < last; ++row) {
            run.check();
            float const* const here = dem.row(row).data();
            float const* const north = dem.row(std::max<std::int64_t>(row - 1, 0)).data();
            float const* const south = dem.row(std::min(row + 1, height - 1)).data();
            float const* const river = valley.z.row(row).data();
            std::int64_t dry_here = 0;
            std::int64_t flat_here = 0;
            for (std::int64_t col = 0; col < width; ++col) {
                float const z = here[col];
                float const west = here[std::max<std::int64_t>(col - 1, 0)];
                float const east = here[std::min(col + 1, width - 1)];
                int const off = static_cast<int>(std::isnan(river[col])) & static_cast<int>(!std::isnan(z));
                int const drained = static_cast<int>(west < z) | static_cast<int>(east < z) |
                                    static_cast<int>(north[col] < z) | static_cast<int>(south[col] < z);
                dry_here += off;
                flat_here += off & (drained ^ 1);
            }
            dry += dry_here;
            flat += flat_here;
        }
    });
    return dry == 0 ? 0.0 : static_cast<double>(flat) / static_cast<double>(dry);
}

constexpr float nan_height = std::numeric_limits<float>::quiet_NaN();

void check_dilate_params(DilateParams const& params) {
    refuse_if<BadParameter>(
        !(params.relief_m >= 0.0 && std::isfinite(params.relief_m)), "surface.dilate",
        "relief is {} m; give a finite height above 0, or 0 for the units of Cao, Long and Lü (2009)", params.relief_m);
    increments(0, params.increment); // reject unreadable expressions before the work
}

/// Factor from the paper's units to metres, where `top` is the largest sum of increments on the grid.
double metres_per_unit(double top, DilateParams const& params, Grid const& grid) {
    if (params.relief_m == 0.0) {
        return grid.cell_m;
    }
    if (!(top > 0.0)) {
        throw BadParameter(
            "surface.dilate",
            fmt::format("the increments{} never rise above the valley, so no factor gives a relief of {} m; choose "
                        "others, or relief 0",
                        params.increment.function ? "" : fmt::format(" '{}'", params.increment.increment),
                        params.relief_m));
    }
    return params.relief_m / top;
}

/// Throws if a surface over valley heights up to `greatest` would exceed the range of float.
void check_reach(std::vector<double> const& above_valley, double greatest) {
    for (std::size_t d = 0; d < above_valley.size(); ++d) {
        refuse_if<BadParameter>(
            !(std::fabs(above_valley[d]) + greatest < static_cast<double>(std::numeric_limits<float>::max())),
            "surface.dilate", "heights pass what a float holds after {} dilations; choose smaller increments", d);
    }
}

/// Scales the increments to metres and sums them, d = 0 .. levels. top: as in metres_per_unit.
std::vector<double> to_metres(std::vector<double>& dh, double top, double greatest, DilateParams const& params,
                              Grid const& grid) {
    if (!dh.empty()) {
        double const factor = metres_per_unit(top, params, grid);
        std::transform(dh.begin(), dh.end(), dh.begin(), [&](double units) { return units * factor; });
    }
    std::vector<double> above_valley = heights_above_valley(dh);
    check_reach(above_valley, greatest);
    return above_valley;
}

/// The same if every level from 0 to the last occurs.
std::vector<double> use_increments(DilatedDem& dilated, double greatest, DilateParams const& params) {
    dilated.increments = increments(dilated.levels, params.increment);
    std::vector<double> const units = heights_above_valley(dilated.increments);
    std::vector<double> sums = to_metres(dilated.increments, *std::max_element(units.begin(), units.end()), greatest,
                                         params, dilated.dem.grid());
    dilated.rise_m = *std::max_element(sums.begin(), sums.end());
    return sums;
}

double greatest_of_valley(Raster<float> const& valley) {
    float greatest = 0.0F;
    for (float const z : valley.values()) {
        greatest = std::fabs(z) > greatest ? std::fabs(z) : greatest;
    }
    return static_cast<double>(greatest);
}

/// Whether every dilation rises by more than one ulp of a float at these heights: then no cell can be flat.
bool surely_drained(std::vector<double> const& used, std::vector<double> const& above_valley, double greatest) {
    double reach = greatest;
    for (double const h : above_valley) {
        reach = std::max(reach, std::fabs(h) + greatest);
    }
    return std::all_of(used.begin(), used.end(), [&](double dh) { return dh > reach * 0x1p-22; });
}

/// Sets flat_share. Every cell is dh above a neighbour, so that flats need to be counted only if dh can vanish.
void report_flats(DilatedDem& dilated, Valley const& valley, std::vector<double> const& above_valley, double greatest,
                  Run const& run) {
    if (!surely_drained(dilated.increments, above_valley, greatest)) {
        dilated.flat_share = flat_share(valley, dilated.dem, run);
    }
}

template <class Level> DilatedDem dilate_closed(Valley const& valley, DilateParams const& params, Run const& run) {
    Lanes const lanes = widest_lanes();
    DilatedDem dilated;
    dilated.dem = Raster<float>(valley.z.grid());
    auto const swept = separable::sweep_down<Level>(valley, dilated.dem, lanes, run);
    if (!separable::usable(swept)) {
        check_heights(valley.z);
    }
    run.at(0.6, "dilate");
    dilated.levels = swept.levels;
    double const greatest = static_cast<double>(swept.greatest);
    std::vector<double> const above_valley = use_increments(dilated, greatest, params);
    separable::sweep_up(swept, dilated.dem, above_valley, lanes, run);
    run.at(0.9, "dilate");
    report_flats(dilated, valley, above_valley, greatest, run);
    run.at(1.0, "dilate");
    return dilated;
}

DilatedDem dilate_masked(Valley const& valley, Mask const& inside, DilateParams const& params, Run const& run) {
    Expansion expansion = expand_frontier(valley, inside, run);
    run.at(0.8, "dilate");
    Raster<std::int32_t> const& level = expansion.level;
    DilatedDem dilated;
    dilated.dem = std::move(expansion.base);
    dilated.levels = *std::max_element(level.values().begin(), level.values().end());
    double const greatest = greatest_of_valley(dilated.dem);
    std::vector<double> const above_valley = use_increments(dilated, greatest, params);
    for (std::int64_t i = 0; i < level.cells(); ++i) {
        if (level[i] > 0) {
            double const base = static_cast<double>(dilated.dem[i]);
            dilated.dem[i] = static_cast<float>(base + above_valley[level[i]]);
        }
    }
    report_flats(dilated, valley, above_valley, greatest, run);
    run.at(1.0, "dilate");
    return dilated;
}

/// Sum of increments up to a distance, also between whole numbers of dilations.
double sum_at(double distance, std::vector<double> const& dh, std::vector<double> const& sums) {
    double const whole = std::floor(distance);
    auto const level = static_cast<std::size_t>(whole);
    return distance == whole ? sums[level] : sums[level] + (distance - whole) * dh[level];
}

double distance_cells(Grid const& grid, std::int64_t from, std::int64_t to) {
    Cell const a = grid.at(from);
    Cell const b = grid.at(to);
    std::int64_t const square = (a.col - b.col) * (a.col - b.col) + (a.row - b.row) * (a.row - b.row);
    return std::sqrt(static_cast<double>(square));
}

DilatedDem dilate_euclid(Valley valley, Mask const& inside, DilateParams const& params, Run const& run) {
    Grid const grid = valley.z.grid();
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (inside[i] == 0) {
            valley.z[i] = nan_height;
        }
    }
    check_heights(valley.z);
    Mask rivers(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        rivers[i] = std::isnan(valley.z[i]) ? 0 : 1;
    }
    Raster<std::int64_t> const nearest = nearest_cells(rivers, run);
    run.at(0.6, "dilate");
    double farthest = 0.0;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (inside[i] != 0) {
            farthest = std::max(farthest, distance_cells(grid, i, nearest[i]));
        }
    }
    DilatedDem dilated;
    dilated.levels = static_cast<std::int64_t>(std::ceil(farthest));
    dilated.increments = increments(dilated.levels, params.increment);
    std::vector<double> const units = heights_above_valley(dilated.increments);
    double top = 0.0;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (inside[i] != 0) {
            top = std::max(top, sum_at(distance_cells(grid, i, nearest[i]), dilated.increments, units));
        }
    }
    std::vector<double> const sums = to_metres(dilated.increments, top, greatest_of_valley(valley.z), params, grid);
    dilated.rise_m = farthest > 0.0 ? top * metres_per_unit(top, params, grid) : 0.0;
    dilated.dem = valley.z;
    parallel_ranges(run, grid.height, 64, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t i = first * grid.width; i < last * grid.width; ++i) {
            if (inside[i] != 0 && nearest[i] != i) {
                double const base = static_cast<double>(valley.z[nearest[i]]);
                double const above = sum_at(distance_cells(grid, i, nearest[i]), dilated.increments, sums);
                dilated.dem[i] = static_cast<float>(base + above);
            }
        }
    });
    run.at(0.9, "dilate");
    dilated.flat_share = flat_share(valley, dilated.dem, run);
    run.at(1.0, "dilate");
    return dilated;
}

template <class Level> Expansion expand_as(Valley const& valley, Run const& run) {
    Lanes const lanes = widest_lanes();
    Expansion expansion{Raster<std::int32_t>(valley.z.grid()), Raster<float>(valley.z.grid())};
    auto const swept = separable::sweep_down<Level>(valley, expansion.base, lanes, run);
    if (!separable::usable(swept)) {
        check_heights(valley.z);
    }
    separable::sweep_up(swept, expansion.base, expansion.level, lanes, run);
    return expansion;
}

/// The same valley at height 0: dilating it gives H(d) alone.
Valley levelled(Valley const& valley, Raster<float> const& base) {
    require_same_grid(base.grid(), valley.z.grid(), "surface.dilate_over", "the base and the valley",
                      "lay the base on the valley's grid");
    Valley level = valley;
    for (float& z : level.z.values()) {
        z = std::isnan(z) ? z : 0.0F;
    }
    return level;
}

DilatedDem on_base(DilatedDem rise, Valley const& valley, Raster<float> const& base, Run const& run) {
    for (std::int64_t i = 0; i < base.cells(); ++i) {
        float const river = valley.z[i];
        rise.dem[i] = std::isnan(river) || std::isnan(rise.dem[i]) ? base[i] + rise.dem[i] : river;
    }
    rise.flat_share = flat_share(valley, rise.dem, run);
    return rise;
}

} // namespace

DilatedDem dilate(Valley const& valley, DilateParams const& params, Run const& run) {
    Grid const& grid = valley.z.grid();
    check_dilate_params(params);
    check_frame(grid);
    run.at(0.0, "dilate");
    if (params.metric == Metric::euclid) {
        return dilate_euclid(valley, Mask(grid, 1), params, run);
    }
    return separable::fits16(grid) ? dilate_closed<std::uint16_t>(valley, params, run)
                                   : dilate_closed<std::int32_t>(valley, params, run);
}

DilatedDem dilate(Valley const& valley, Mask const& inside, DilateParams const& params, Run const& run) {
    check_dilate_params(params);
    check_frame(valley.z.grid());
    check_mask(valley.z.grid(), inside.grid());
    run.at(0.0, "dilate");
    if (params.metric == Metric::euclid) {
        return dilate_euclid(valley, inside, params, run);
    }
    bool const open = std::none_of(inside.values().begin(), inside.values().end(), [](auto cell) { return cell == 0; });
    return open ? dilate(valley, params, run) : dilate_masked(valley, inside, params, run);
}

Expansion expand_frontier(Valley const& valley, Mask const& inside, Run const& run) {
    Grid const& grid = valley.z.grid();
    check_frame(grid);
    check_mask(grid, inside.grid());
    Expansion expansion{Raster<std::int32_t>(grid, -1), valley.z};
    Raster<std::int32_t>& level = expansion.level;
    Raster<float>& base = expansion.base;
    std::vector<std::int64_t> frontier;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (inside[i] == 0 || std::isnan(base[i])) {
            base[i] = std::numeric_limits<float>::quiet_NaN();
        } else {
            level[i] = 0;
            frontier.push_back(i);
        }
    }
    check_heights(base);
    std::vector<std::int64_t> next;
    for (std::int32_t x = 1; !frontier.empty(); ++x) {
        run.check();
        next.clear();
        for (std::int64_t const from : frontier) {
            auto const spread = [&](std::int64_t to) {
                if (level[to] < 0 && inside[to] != 0) {
                    level[to] = x;
                    base[to] = base[from];
                    next.push_back(to);
                } else if (level[to] == x && separable::ordered(base[from]) < separable::ordered(base[to])) {
                    base[to] = base[from];
                }
            };
            std::int64_t const col = from % grid.width;
            if (col > 0) {
                spread(from - 1);
            }
            if (col + 1 < grid.width) {
                spread(from + 1);
            }
            if (from >= grid.width) {
                spread(from - grid.width);
            }
            if (from + grid.width < grid.cells()) {
                spread(from + grid.width);
            }
        }
        frontier.swap(next);
    }
    return expansion;
}

Expansion expand(Valley const& valley, Run const& run) {
    check_frame(valley.z.grid());
    return separable::fits16(valley.z.grid()) ? expand_as<std::uint16_t>(valley, run)
                                              : expand_as<std::int32_t>(valley, run);
}

DilatedDem dilate_over(Valley const& valley, Raster<float> const& base, DilateParams const& params, Run const& run) {
    return on_base(dilate(levelled(valley, base), params, run), valley, base, run);
}

DilatedDem dilate_over(Valley const& valley, Raster<float> const& base, Mask const& inside, DilateParams const& params,
                       Run const& run) {
    return on_base(dilate(levelled(valley, base), inside, params, run), valley, base, run);
}

} // namespace thalweg::surface
