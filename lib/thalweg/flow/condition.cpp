// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/condition.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/internal/condition.hpp>
#include <thalweg/flow/internal/priority_flood.hpp>

namespace thalweg::flow {

void flood(Raster<float>& land, Raster<float> const& rivers, Lakes lakes, Run const& run) {
    auto const is_river = [&](std::int64_t i) { return !std::isnan(rivers[i]); };
    auto const rise = [&](float z) { return lakes == Lakes::level ? z : just_above(z); };
    priority_flood(land, is_river, rise, "carve", run);
}

bool drains(Raster<float> const& dem, Raster<float> const& rivers, Run const& run) {
    if (dem.width() < 3) {
        return true;
    }
    auto const width = static_cast<std::size_t>(dem.width());
    std::array<std::vector<float>, 3> lows; // by row modulo 3: the lowest of a cell and those to its left and right
    lows.fill(std::vector<float>(width));
    std::vector<float> heights(width);
    for (std::int64_t r = 0; r < dem.height(); ++r) {
        if (r % 1024 == 0) {
            run.check();
        }
        auto const row = dem.row(r);
        for (std::size_t c = 0; c < width; ++c) {
            heights[c] = std::isnan(row[c]) ? -std::numeric_limits<float>::infinity() : row[c]; // water leaves there
        }
        std::vector<float>& low = lows[static_cast<std::size_t>(r % 3)];
        for (std::size_t c = 1; c + 1 < width; ++c) {
            low[c] = std::min(std::min(heights[c - 1], heights[c + 1]), heights[c]);
        }
        if (r < 2) {
            continue;
        }
        auto const here = dem.row(r - 1);
        auto const river = rivers.row(r - 1);
        bool all = true;
        for (std::size_t c = 1; c + 1 < width; ++c) {
            float const lowest = std::min(std::min(lows[0][c], lows[1][c]), lows[2][c]);
            all &= just_above(lowest) <= here[c] || std::isnan(here[c]) || !std::isnan(river[c]);
        }
        if (!all) {
            return false;
        }
    }
    return true;
}

void check_drainable(Raster<float> const& dem, Valley const& valley) {
    Grid const& grid = dem.grid();
    refuse_if<BadInput>(grid.cells() == 0, "flow.condition: the land has no cells");
    refuse_if<BadInput>(valley.z.grid() != grid,
                        "flow.condition: the valley has {} x {} cells, the land {} x {}; make both on one grid",
                        valley.z.width(), valley.z.height(), grid.width, grid.height);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (std::isinf(dem[i]) || (std::isnan(dem[i]) && !std::isnan(valley.z[i]))) {
            Cell const cell = grid.at(i);
            throw BadInput(fmt::format("flow.condition: the height at column {}, row {} is {}", cell.col, cell.row,
                                       std::isinf(dem[i]) ? "infinite; mark cells without data as NaN"
                                                          : "missing, where a river runs"));
        }
    }
}

Raster<float> fill(Raster<float> const& dem, Valley const& valley, Run const& run) {
    check_drainable(dem, valley);
    if (drains(dem, valley.z, run)) {
        return dem;
    }
    Raster<float> level = framed(dem);
    flood(level, framed(valley.z), Lakes::slope, run);
    return unframed(level, dem.grid());
}

namespace {

/// The lower river neighbours of a river cell.
struct Pull {
    double slope = 0.0; ///< [m/cell] the steepest
    double lowest = std::numeric_limits<double>::infinity();
};

Pull pull_at(Raster<float> const& valley, Cell at) {
    Pull pull;
    double const here = valley[at];
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        Cell const n{at.col + d8_steps[k].col, at.row + d8_steps[k].row};
        if (valley.grid().contains(n) && valley[n] < valley[at]) { // never NaN
            double const there = valley[n];
            pull.slope = std::max(pull.slope, (here - there) * d8_per_length[k]);
            pull.lowest = std::min(pull.lowest, there);
        }
    }
    return pull;
}

/// The float at or next above a height.
float rounded_up(double z) {
    auto const near = static_cast<float>(z);
    return static_cast<double>(near) < z ? just_above(near) : near;
}

} // namespace

Banks confine_channels(Raster<float> const& dem, Valley const& valley, RaiseBanksParams const& params, Run const& run) {
    refuse_if<BadParameter>(!(params.margin_m >= 0.0 && params.margin_m < 1e6),
                            "flow.confine_channels: margin {} m; give one from 0", params.margin_m);
    Grid const& grid = dem.grid();
    refuse_if<BadInput>(valley.z.grid() != grid,
                        "flow.confine_channels: the valley has {} x {} cells, the land {} x {}; make both on one grid",
                        valley.z.width(), valley.z.height(), grid.width, grid.height);
    Banks banks{dem, Raster<float>(grid, std::numeric_limits<float>::quiet_NaN())};
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (i % (1 << 20) == 0) {
            run.check();
        }
        if (std::isnan(valley.z[i])) {
            continue;
        }
        Cell const at = grid.at(i);
        double const here = valley.z[i];
        Pull const pull = pull_at(valley.z, at);
        for (std::size_t k = 0; k < d8_steps.size(); ++k) {
            Cell const n{at.col + d8_steps[k].col, at.row + d8_steps[k].row};
            if (!grid.contains(n) || std::isnan(dem[n]) || !std::isnan(valley.z[n])) {
                continue;
            }
            double const bank = pull.slope > 0.0 ? std::max(pull.lowest, here - pull.slope / d8_per_length[k]) : here;
            float const least = std::max(rounded_up(bank + params.margin_m), just_above(static_cast<float>(bank)));
            if (!(banks.least[n] >= least)) {
                banks.least[n] = least;
                banks.dem[n] = std::max(banks.dem[n], least);
            }
        }
    }
    return banks;
}

DemChange change_between(Raster<float> const& before, Raster<float> const& after) {
    DemChange change;
    double const cell_m2 = before.grid().cell_m * before.grid().cell_m;
    for (std::int64_t r = 0; r < before.height(); ++r) {
        auto const was = before.row(r);
        auto const is = after.row(r);
        double raised_m = 0.0; // per row, so that a large sum does not absorb small changes
        double cut_m = 0.0;
        for (std::size_t c = 0; c < was.size(); ++c) {
            double const rise = static_cast<double>(is[c]) - static_cast<double>(was[c]);
            if (rise > 0.0) {
                ++change.raised_cells;
                change.max_raise_m = std::max(change.max_raise_m, rise);
                raised_m += rise;
            } else if (rise < 0.0) {
                ++change.cut_cells;
                change.max_cut_m = std::max(change.max_cut_m, -rise);
                cut_m -= rise;
            }
        }
        change.raised_m3 += raised_m * cell_m2;
        change.cut_m3 += cut_m * cell_m2;
    }
    return change;
}

ConditionedDem condition(Raster<float> dem, Valley const& valley, ConditionParams const& params, Run const& run) {
    ConditionedDem out;
    if (params.method == Conditioning::none) {
        out.dem = std::move(dem);
        return out;
    }
    check_drainable(dem, valley);
    Banks const banks = confine_channels(dem, valley, {}, run);
    out.dem =
        params.method == Conditioning::fill ? fill(banks.dem, valley, run) : carve(banks.dem, valley, banks.least, run);
    out.banks = change_between(dem, banks.dem);
    out.depressions = change_between(banks.dem, out.dem);
    return out;
}

} // namespace thalweg::flow
