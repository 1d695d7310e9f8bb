// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/internal/plan.hpp>

#include <thalweg/pipeline/recipe/internal/check_recipe.hpp>

#include <algorithm>

namespace thalweg::pipeline {

bool has_coastlines(Plan const& plan) {
    NetworkRecipe const& rivers = *plan.recipe.network;
    std::vector<SecondaryLine> const& lines = plan.lines.secondary;
    return rivers.source == Source::lines && rivers.lines.coastlines == Coastlines::sea &&
           std::any_of(lines.begin(), lines.end(),
                       [](SecondaryLine const& line) { return line.cause == LeftOut::coast; });
}

bool grown_for_land(Plan const& plan) {
    return plan.recipe.network->source != Source::lines && in_equilibrium(plan.recipe);
}

bool bends_rivers(Plan const& plan) {
    return *plan.recipe.network->meander != 0.0 || grown_for_land(plan);
}

bool follows_land(Recipe const& recipe) {
    return in_equilibrium(recipe) && recipe.network->heights == Heights::graded;
}

bool scatters(Recipe const& recipe) {
    return recipe.skeleton && recipe.skeleton->scatter > 0;
}

bool has_ridges(Recipe const& recipe) {
    return recipe.skeleton && recipe.skeleton->ridges != Ridges::none;
}

bool needs_tin(Recipe const& recipe) {
    SurfaceRecipe const& wanted = *recipe.surface;
    bool const over_tin = wanted.method == Method::tin || (wanted.method == Method::dilate && wanted.base == Base::tin);
    return over_tin || (recipe.skeleton && recipe.skeleton->tin);
}

bool conditions(Recipe const& recipe) {
    return recipe.surface && *recipe.surface->drain != flow::Conditioning::none;
}

bool fills_space(Recipe const& recipe) {
    return recipe.network && recipe.network->fill_space;
}

} // namespace thalweg::pipeline
