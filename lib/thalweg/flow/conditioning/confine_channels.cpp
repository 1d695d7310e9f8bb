// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/conditioning/internal/confine_channels.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/conditioning/internal/small_step.hpp>

namespace thalweg::flow {

namespace {

/// What draws the water of a river cell on: its lower neighbours of the river.
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
    if (!(params.margin_m >= 0.0 && params.margin_m < 1e6)) {
        throw BadParameter(fmt::format("flow.confine_channels: margin {} m; give one from 0", params.margin_m));
    }
    Grid const& grid = dem.grid();
    if (valley.z.grid() != grid) {
        throw BadInput(
            fmt::format("flow.confine_channels: the valley has {} x {} cells, the land {} x {}; make both on one "
                        "grid",
                        valley.z.width(), valley.z.height(), grid.width, grid.height));
    }
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

} // namespace thalweg::flow
