// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include <fmt/format.h>

#include <thalweg/make/internal/between_rivers.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {

Surface tin(GroundInput const& in, Run const& run) {
    StageLog stage_log(run);
    Between between = between_rivers(in, stage_log, run);
    Raster<float> dem = stage_log.stage(recipe::stage::fill.name,
                                        [&] { return only_inside(over_triangles(between, run), between.inside); });
    stage_log.say(fmt::format("{}x{}, over triangles", in.grid.width, in.grid.height));
    return surface_between(in, std::move(between), std::move(dem), OverTriangles{}, {}, stage_log);
}

} // namespace thalweg::make
