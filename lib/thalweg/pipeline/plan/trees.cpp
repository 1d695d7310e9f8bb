// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/internal/plan.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/pipeline/plan/frame.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// Throws before a network is laid out that has no chance: links would lie at less than half the distance they keep.
void require_room(std::int64_t links, Grid const& grid, double spacing_cells) {
    double const apart = std::sqrt(static_cast<double>(grid.cells()) / static_cast<double>(links));
    double const kept = std::max(spacing_cells, 1.0);
    if (links > 1 && apart < 0.5 * kept) {
        throw BadInput(fmt::format("[network.tokunaga]: {} links on {} x {} cells lie {:.2g} cells apart, and keep {} "
                                   "cells from one another: {}",
                                   links, grid.width, grid.height, apart, kept, more_room));
    }
}

} // namespace

network::TokunagaParams tree_of(Recipe const& recipe) {
    TokunagaRecipe const& wanted = recipe.network->tokunaga;
    network::TokunagaParams params;
    params.seed = recipe.seed;
    params.generator = wanted.generator;
    params.order = wanted.order;
    params.rule = wanted.rule;
    return params;
}

Plan plan_tree(Recipe recipe, Diary& diary, Run const& run) {
    TokunagaRecipe const& wanted = recipe.network->tokunaga;
    recipe.grid.crs = io::projected_crs(recipe.grid.crs.empty() ? "EPSG:32631" : recipe.grid.crs);
    Plan plan;
    plan.tree = diary.stage("grow", [&] { return network::grow_tokunaga(tree_of(recipe), run); });
    diary.say(fmt::format("lambda {}  order {}  {} links", wanted.generator, wanted.order, plan.tree->links.size()));
    if (!wanted.region.empty()) {
        plan.region = io::read_polygons(file_in(recipe, wanted.region), recipe.grid.crs, run);
    }
    auto const links = static_cast<std::int64_t>(plan.tree->links.size());
    plan.grid = plan.region ? frame_polygons(*plan.region, recipe.grid) : frame_tree(links, recipe.grid);
    require_room(links, *plan.grid, wanted.spacing_cells);
    plan.recipe = std::move(recipe);
    return plan;
}

Plan plan_strokes(Recipe recipe, Diary& diary, Run const& run) {
    TokunagaRecipe const& wanted = recipe.network->tokunaga;
    std::string const crs = recipe.grid.crs.empty() ? "" : io::projected_crs(recipe.grid.crs);
    RiverLines strokes = diary.stage("read", [&] {
        return io::read_rivers({.path = file_in(recipe, wanted.strokes), .layer = wanted.layer, .crs = crs}, run);
    });
    if (!strokes.findings.empty()) { // who draws strokes means each of them
        Finding const& none = strokes.findings.front();
        throw BadInput(
            fmt::format("pipeline.plan_tokunaga: stroke {} of {} at ({:.3f}, {:.3f}) is a single point or has no "
                        "geometry; remove it",
                        none.feature, strokes.name, none.where.x, none.where.y));
    }
    recipe.grid.crs = strokes.crs;
    diary.say(fmt::format("{} strokes from {}", strokes.lines.size(), strokes.name));
    Plan plan;
    plan.grid = frame_lines(strokes, recipe.grid);
    plan.lines = std::move(strokes);
    plan.recipe = std::move(recipe);
    return plan;
}

} // namespace thalweg::pipeline
