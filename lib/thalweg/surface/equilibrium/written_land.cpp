// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/written_land.hpp>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/flow/direction.hpp>
#include <thalweg/flow/steepest_descent.hpp>
#include <thalweg/surface/equilibrium/internal/give_up_tips.hpp>
#include <thalweg/surface/equilibrium/internal/keep_to_receivers.hpp>
#include <thalweg/surface/equilibrium/internal/perched_rivers.hpp>
#include <thalweg/surface/equilibrium/internal/rise_of.hpp>
#include <thalweg/surface/equilibrium/internal/settle_land.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace thalweg::surface {

namespace {

/// Copies the caller's grid out of the level; NaN at sea.
Raster<float> cropped(LandLevel const& level, Window const& window) {
    Raster<float> dem(window.grid);
    Mask const& land = window.land;
    std::int64_t const margin = window.margin;
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        for (std::int64_t col = 0; col < dem.width(); ++col) {
            auto const i = static_cast<std::size_t>((row + margin + 1) * level.width + col + margin + 1);
            bool const dry = land.cells() == 0 || land[Cell{col, row}] != 0;
            dem[Cell{col, row}] = dry ? level.z[i] : std::numeric_limits<float>::quiet_NaN();
        }
    }
    return dem;
}

/// The lowest height at which a river ends on the caller's grid.
float lowest_end(Raster<float> const& dem, Channels const& rivers) {
    float low = std::numeric_limits<float>::infinity();
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] < 0) {
            low = std::min(low, dem[rivers.cell[n]]);
        }
    }
    return low;
}

Raster<flow::Direction> directions(Raster<float> const& dem, Channels const& rivers,
                                   std::vector<std::int64_t> const& shortened, Run const& run) {
    Raster<flow::Direction> out(dem.grid(), flow::Direction::no_data);
    parallel_ranges(run, dem.height(), 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            for (std::int64_t col = 0; col < dem.width(); ++col) {
                if (Cell const c{col, row}; !std::isnan(dem[c])) {
                    out[c] = flow::steepest_descent(dem, c).direction;
                }
            }
        }
    });
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        std::int64_t const r = rivers.receiver[n];
        if (std::binary_search(shortened.begin(), shortened.end(), static_cast<std::int64_t>(n))) {
            continue;
        }
        if (r < 0) {
            out[rivers.cell[n]] = flow::Direction::leaves;
            continue;
        }
        Cell const from = dem.grid().at(rivers.cell[n]);
        Cell const to = dem.grid().at(rivers.cell[static_cast<std::size_t>(r)]);
        for (std::size_t k = 0; k < d8_steps.size(); ++k) {
            if (d8_steps[k] == Cell{to.col - from.col, to.row - from.row}) {
                out[rivers.cell[n]] = flow::direction_of(k);
            }
        }
    }
    return out;
}

float perched_height(Raise const& raise, Grid const& grid) {
    return static_cast<float>(raise.mean_tangent * grid.cell_m);
}

void to_metres(LandLevel& level, Raise const& raise) {
    for (float& z : level.z) {
        z = static_cast<float>(raise.base_m + static_cast<double>(z) * raise.metres);
    }
}

/// Less than the solver keeps, so that nothing is touched but what floats have lost.
float settled_step(Raise const& raise) {
    return static_cast<float>(0.25 * static_cast<double>(least_tangent) * raise.metres);
}

/// Cells without an asked height stand no higher than what is asked upstream: in the solver floats of what lies beyond
/// the caller's grid, a step up each, may have lifted them.
void keep_below_asked(LandLevel& level, Channels const& rivers) {
    RiverCells const& cells = level.rivers;
    for (std::size_t n = cells.cell.size(); n-- > 0;) {
        if (cells.receiver[n] < 0 || cells.level[n] != 0) {
            continue;
        }
        auto const r = static_cast<std::size_t>(cells.receiver[n]);
        std::int64_t const number = cells.number[r];
        if (number >= 0 && std::isnan(rivers.z[static_cast<std::size_t>(number)])) {
            level.z[cells.cell[r]] = std::min(level.z[cells.cell[r]], level.z[cells.cell[n]]);
        }
    }
}

/// Puts the lowest end of a river at 0, where all ends have risen.
void lower_to_ends(LandLevel& level, Channels const& rivers) {
    RiverCells const& cells = level.rivers;
    float low = std::numeric_limits<float>::infinity();
    for (std::size_t n = 0; n < cells.cell.size(); ++n) {
        if (cells.number[n] >= 0 && rivers.receiver[static_cast<std::size_t>(cells.number[n])] < 0) {
            low = std::min(low, level.z[cells.cell[n]]);
        }
    }
    if (low > 0.0F && std::isfinite(low)) {
        for (float& z : level.z) {
            z -= low;
        }
    }
}

void tell_lowered(Raster<float> const& dem, Channels const& rivers, EquilibriumTerrain& out) {
    std::vector<double> lowered;
    for (std::size_t n = 0; n < rivers.z.size(); ++n) {
        if (!std::isnan(rivers.z[n])) {
            double const depth = static_cast<double>(rivers.z[n]) - static_cast<double>(dem[rivers.cell[n]]);
            lowered.push_back(std::max(0.0, depth));
        }
    }
    std::sort(lowered.begin(), lowered.end());
    out.max_lowered_m = lowered.back();
    out.p95_lowered_m = lowered[(lowered.size() - 1) * 95 / 100];
}

} // namespace

Raise raise_for(LandLevel const& level, Channels const& rivers, Window const& window, EquilibriumParams const& params) {
    Raster<float> const dem = cropped(level, window);
    Rise const rise = rise_of(dem, params);
    double const metres = rise.factor * window.grid.cell_m;
    return {metres, -static_cast<double>(lowest_end(dem, rivers)) * metres, rise.mean_tangent};
}

double share_of_target(LandLevel const& level, Window const& window, double metres, EquilibriumParams const& params) {
    return share_of_target(cropped(level, window), metres / window.grid.cell_m, params);
}

EquilibriumTerrain written_land(LandLevel level, Channels const& rivers, Window const& window, Raise const& raise,
                                std::vector<std::int64_t> shortened, Heads heads, Run const& run) {
    EquilibriumTerrain out;
    out.rise = raise.metres / window.grid.cell_m;
    to_metres(level, raise);
    // A little lower than what counts as perched, for what is settled afterwards.
    lower_perched(level, 0.99F * perched_height(raise, window.grid), 4.0F * settled_step(raise));
    if (heads == Heads::kept) {
        keep_to_receivers(level, settled_step(raise));
        lower_to_ends(level, rivers);
    }
    raise_below_perched(level, 0.99F * perched_height(raise, window.grid));
    settle_land(level, settled_step(raise), RiverHeights::graded);
    out.dem = cropped(level, window);
    float const perched_m = perched_height(raise, window.grid);
    if (heads == Heads::kept) {
        out.walled = walled_cells(level, perched_m);
    }
    auto const perched =
        heads == Heads::kept ? std::vector<std::int64_t>{} : give_up_tips(level, perched_m, TipBanks::stay);
    shortened.insert(shortened.end(), perched.begin(), perched.end());
    std::sort(shortened.begin(), shortened.end());
    out.shortened = std::move(shortened);
    level = {};
    out.direction = directions(out.dem, rivers, out.shortened, run);
    return out;
}

EquilibriumTerrain written_given_land(LandLevel level, Channels const& rivers, Window const& window, Raise const& raise,
                                      RiverHeights heights, Run const& run) {
    EquilibriumTerrain out;
    out.rise = raise.metres / window.grid.cell_m;
    to_metres(level, raise);
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        std::int64_t const number = level.rivers.number[n];
        float const asked = number < 0 ? std::nanf("") : rivers.z[static_cast<std::size_t>(number)];
        if (!std::isnan(asked)) {
            float& z = level.z[level.rivers.cell[n]];
            z = heights == RiverHeights::soft ? std::min(z, asked) : asked;
        }
    }
    keep_below_asked(level, rivers);
    if (heights != RiverHeights::fixed) { // as graded rivers are
        lower_perched(level, 0.99F * perched_height(raise, window.grid), 4.0F * settled_step(raise));
        raise_below_perched(level, 0.99F * perched_height(raise, window.grid));
    }
    settle_land(level, settled_step(raise), heights);
    out.dem = cropped(level, window);
    out.walled = walled_cells(level, perched_height(raise, window.grid));
    level = {};
    out.direction = directions(out.dem, rivers, {}, run);
    tell_lowered(out.dem, rivers, out);
    return out;
}

} // namespace thalweg::surface
