// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/written_land.hpp>

#include <thalweg/core/d8.hpp>
#include <thalweg/core/parallel.hpp>
#include <thalweg/surface/give_up_tips.hpp>
#include <thalweg/surface/rise_of.hpp>
#include <thalweg/surface/settle_land.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace thalweg::surface {

namespace {

constexpr std::int8_t leaves = -1;
constexpr std::int8_t at_sea = -2;

/// Copies the caller's grid out of the level; NaN at sea.
void crop(LandLevel const& level, Mask const& land, std::int64_t margin, Raster<float>& dem) {
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        for (std::int64_t col = 0; col < dem.width(); ++col) {
            auto const i = static_cast<std::size_t>((row + margin + 1) * level.width + col + margin + 1);
            bool const dry = land.cells() == 0 || land[Cell{col, row}] != 0;
            dem[Cell{col, row}] = dry ? level.z[i] : std::numeric_limits<float>::quiet_NaN();
        }
    }
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

std::int8_t steepest_descent(Raster<float> const& dem, Cell c) {
    float const z = dem[c];
    if (std::isnan(z)) {
        return at_sea;
    }
    double best = 0.0;
    std::int8_t way = leaves;
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        Cell const n{c.col + d8_steps[k].col, c.row + d8_steps[k].row};
        if (!dem.grid().contains(n)) {
            continue;
        }
        double const slope = (static_cast<double>(z) - static_cast<double>(dem[n])) * d8_per_length[k];
        if (slope > best) { // never towards NaN
            best = slope;
            way = static_cast<std::int8_t>(k);
        }
    }
    return way;
}

Raster<std::int8_t> directions(Raster<float> const& dem, Channels const& rivers,
                               std::vector<std::int64_t> const& shortened, Run const& run) {
    Raster<std::int8_t> out(dem.grid());
    parallel_ranges(run, dem.height(), 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            for (std::int64_t col = 0; col < dem.width(); ++col) {
                out[Cell{col, row}] = steepest_descent(dem, {col, row});
            }
        }
    });
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        std::int64_t const r = rivers.receiver[n];
        if (std::binary_search(shortened.begin(), shortened.end(), static_cast<std::int64_t>(n))) {
            continue;
        }
        if (r < 0) {
            out[rivers.cell[n]] = leaves;
            continue;
        }
        Cell const from = dem.grid().at(rivers.cell[n]);
        Cell const to = dem.grid().at(rivers.cell[static_cast<std::size_t>(r)]);
        for (std::size_t k = 0; k < d8_steps.size(); ++k) {
            if (d8_steps[k] == Cell{to.col - from.col, to.row - from.row}) {
                out[rivers.cell[n]] = static_cast<std::int8_t>(k);
            }
        }
    }
    return out;
}

} // namespace

EquilibriumLand written_land(LandLevel level, Channels const& rivers, Mask const& land, EquilibriumParams const& params,
                             std::int64_t margin, std::vector<std::int64_t> shortened, Run const& run) {
    EquilibriumLand out;
    out.dem = Raster<float>(rivers.grid);
    crop(level, land, margin, out.dem);
    Rise const rise = rise_of(out.dem, params);
    out.rise = rise.factor;
    double const base = static_cast<double>(lowest_end(out.dem, rivers));
    double const metres = out.rise * rivers.grid.cell_m;
    for (float& z : level.z) {
        z = static_cast<float>((static_cast<double>(z) - base) * metres);
    }
    // Less than the solver keeps, so that nothing is touched but what floats have lost.
    settle_land(level, static_cast<float>(0.25 * static_cast<double>(least_tangent) * metres));
    crop(level, land, margin, out.dem);
    auto const perched = give_up_tips(level, static_cast<float>(rise.mean_tangent * rivers.grid.cell_m));
    shortened.insert(shortened.end(), perched.begin(), perched.end());
    std::sort(shortened.begin(), shortened.end());
    out.shortened = std::move(shortened);
    level = {};
    out.direction = directions(out.dem, rivers, out.shortened, run);
    return out;
}

} // namespace thalweg::surface
