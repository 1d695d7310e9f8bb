// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/paste_patches.hpp>

#include <thalweg/pipeline/make/blend_into.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/recipe/internal/check_recipe.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <utility>

namespace thalweg::pipeline {

namespace {

MakeBlendParams params_of(Recipe const& recipe, PatchRecipe const& patch) {
    MakeBlendParams params;
    params.target = "the land";
    params.source = file_in(recipe, patch.source);
    params.mask = file_in(recipe, patch.mask);
    if (patch.at) {
        params.at = Vec2{(*patch.at)[0], (*patch.at)[1]};
    }
    if (patch.window) {
        auto const cells = [&](std::size_t i) { return static_cast<std::int64_t>((*patch.window)[i]); };
        params.window = blend::SourceWindow{cells(0), cells(1), cells(2), cells(3)};
    }
    params.rotate_deg = patch.rotate_deg;
    params.scale = patch.scale;
    params.gain = patch.gain;
    params.feather_cells = patch.feather_cells;
    return params;
}

} // namespace

Terrain with_patches(Plan const& plan, Terrain drawn, Diary& diary, Run const& run) {
    for (PatchRecipe const& patch : plan.recipe.patches) {
        bool const keeps = patch.rivers == PatchRivers::keep && plan.recipe.network.has_value();
        MadeBlend made = diary.stage("blend", [&] {
            return blend_into(drawn.surface->dem, keeps ? river_mask(drawn.valley) : Mask{},
                              params_of(plan.recipe, patch), run);
        });
        drawn.surface->dem = std::move(made.pasted.dem);
        drawn.patches.push_back({made.pasted.cells, made.pasted.kept, made.pasted.seam_max_m, made.pasted.seam_rms_m});
        diary.say(
            fmt::format("{} cells of {}, seam {:.2g} m", made.pasted.cells, patch.source, made.pasted.seam_rms_m));
    }
    if (plan.recipe.network && replaces_rivers(plan.recipe)) {
        drawn.valley = honoured_valley(std::move(drawn.valley), drawn.network.plan, drawn.surface->dem);
    }
    return drawn;
}

} // namespace thalweg::pipeline
