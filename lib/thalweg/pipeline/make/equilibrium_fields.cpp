// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/equilibrium_fields.hpp>

#include <thalweg/pipeline/plan/internal/read_inputs.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>
#include <thalweg/surface/uplift/uplift_pattern.hpp>

#include <utility>

namespace thalweg::pipeline {

namespace {

/// Cells that are land by both masks, of which either may be empty; and those of rivers.
Mask land_of(Mask one, Mask const& other, Channels const& channels) {
    if (one.values().empty()) {
        one = other;
    } else if (!other.values().empty()) {
        for (std::int64_t i = 0; i < one.cells(); ++i) {
            one[i] = one[i] != 0 && other[i] != 0 ? 1 : 0;
        }
    }
    if (!one.values().empty()) {
        for (std::int64_t const cell : channels.cell) {
            one[cell] = 1;
        }
    }
    return one;
}

/// Uplift of a file, which may be empty, times that of the pattern asked for.
Raster<float> with_pattern(Raster<float> of_file, Recipe const& recipe, Grid const& grid, Run const& run) {
    EquilibriumRecipe const& wanted = recipe.surface->equilibrium;
    if (!wanted.uplift_pattern) {
        return of_file;
    }
    Raster<float> uplift =
        surface::uplift_pattern(grid,
                                {.pattern = *wanted.uplift_pattern,
                                 .contrast = wanted.uplift_contrast,
                                 .wave_m = wanted.uplift_wave_m,
                                 .strike_deg = wanted.strike_deg.value_or(surface::random_strike_deg(recipe.seed)),
                                 .seed = recipe.seed},
                                run);
    for (std::int64_t i = 0; i < of_file.cells(); ++i) {
        uplift[i] *= of_file[i];
    }
    return uplift;
}

} // namespace

surface::EquilibriumFields equilibrium_fields(Plan const& plan, Terrain const& terrain, Channels const& channels,
                                              Run const& run) {
    Recipe const& recipe = plan.recipe;
    Grid const& grid = terrain.grid;
    SurfaceRecipe const& wanted = *recipe.surface;
    surface::EquilibriumFields fields;
    fields.land = land_of(read_mask_of_land(file_in(recipe, recipe.surface->mask), grid), terrain.land, channels);
    fields.uplift = with_pattern(read_field(file_in(recipe, wanted.equilibrium.uplift), grid, "surface.uplift", run),
                                 recipe, grid, run);
    fields.erodibility = read_field(file_in(recipe, wanted.equilibrium.erodibility), grid, "surface.erodibility", run);
    return fields;
}

} // namespace thalweg::pipeline
