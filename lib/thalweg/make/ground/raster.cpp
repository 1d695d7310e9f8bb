// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <thalweg/make/internal/between_rivers.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {
namespace {

/// The cells of a raster that coarse cells lie over; at its eastern and southern edge the last ones.
Raster<float> every_cell(Raster<float> const& raster, Grid const& coarse, int levels) {
    Raster<float> dem(coarse);
    auto const at = [&](std::int64_t i, std::int64_t side) { return std::min(i << levels, side - 1); };
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        Cell const c = coarse.at(i);
        dem[i] = raster[Cell{at(c.col, raster.width()), at(c.row, raster.height())}];
    }
    return dem;
}

/// The DEM, with the cells of rivers.
Surface around_rivers(GroundInput const& in, Run const& run) {
    StageLog stage_log(run);
    Between between = between_rivers(in, stage_log, run);
    Raster<float> dem = stage_log.stage(
        recipe::stage::fill.name, [&] { return only_inside(with_valley(in.raster, between.valley), between.inside); });
    stage_log.say(fmt::format("{}x{}, of the DEM", in.grid.width, in.grid.height));
    return surface_between(in, std::move(between), std::move(dem), OfDem{}, {}, stage_log);
}

} // namespace

Surface raster(GroundInput const& in, Run const& run) {
    if (in.recipe.network) {
        return around_rivers(in, run);
    }
    StageLog stage_log(run);
    Raster<float> dem = stage_log.stage(recipe::stage::land.name,
                                        [&] { return every_cell(in.raster, in.grid, recipe::levels_of(in.recipe)); });
    stage_log.say(fmt::format("{}x{} cells of the DEM", in.grid.width, in.grid.height));
    return {.ground = {.dem = std::move(dem), .how = OfDem{}},
            .notes = {{}, stage_log.take_findings(), stage_log.take()}};
}

} // namespace thalweg::make
