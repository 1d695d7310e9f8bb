// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/stages.hpp>

#include <algorithm>

#include <thalweg/recipe/check_recipe.hpp>

namespace thalweg::recipe {
namespace {

bool has(Recipe const& recipe, Source source) {
    return recipe.network && recipe.network->source == source;
}

bool has_strokes(Recipe const& recipe) {
    return has(recipe, Source::tokunaga) && !recipe.network->tokunaga.strokes.empty();
}

/// A surface around rivers.
bool is_around(Recipe const& recipe) {
    return recipe.network && recipe.surface;
}

/// A surface without rivers.
bool is_alone(Recipe const& recipe) {
    return !recipe.network;
}

bool has_surface(Recipe const& recipe) {
    return recipe.surface || !recipe.network;
}

bool has_ridges(Recipe const& recipe) {
    return recipe.skeleton && recipe.skeleton->ridges != Ridges::none;
}

bool needs_tin(Recipe const& recipe) {
    SurfaceRecipe const& wanted = *recipe.surface;
    bool const over_tin = wanted.method == Method::tin || (wanted.method == Method::dilate && wanted.base == Base::tin);
    return over_tin || (recipe.skeleton && recipe.skeleton->tin);
}

using R = Recipe const&;
using Lines = RiverLines const&;

constexpr double usual = 0.1; ///< [s] a million cells

} // namespace

namespace stage {

Stage const raster{"raster", usual, [](R r, Lines) { return on_raster(r); }};
Stage const read{"read", usual, [](R r, Lines) { return has(r, Source::lines) || has_strokes(r); }};
Stage const shape{"shape", usual, [](R r, Lines) { return has(r, Source::forest); }};
Stage const grow{"grow", usual, [](R r, Lines) { return r.network && !has(r, Source::lines); }};
Stage const thin{"thin", usual, [](R r, Lines) { return has(r, Source::dla); }};
Stage const trace{"trace", usual, [](R r, Lines) { return has(r, Source::dla); }};
Stage const embed{"embed", usual, [](R r, Lines) { return has(r, Source::tokunaga) && !has_strokes(r); }};
Stage const adopt{"adopt", usual, [](R r, Lines) { return has(r, Source::lines); }};
Stage const sea{"sea", usual, [](R r, Lines lines) {
                    return has(r, Source::lines) && r.network->lines.coastlines == Coastlines::sea &&
                           std::ranges::any_of(lines.secondary,
                                               [](SecondaryLine const& line) { return line.cause == LeftOut::coast; });
                }};
Stage const prune{"prune", usual, [](R r, Lines) { return r.network.has_value(); }};
Stage const meander{"meander", 0.7, [](R r, Lines) {
                        return r.network && (r.network->meander.value_or(0.0) != 0.0 ||
                                             (!has(r, Source::lines) && in_equilibrium(r)));
                    }};
Stage const raise{"raise", usual, [](R r, Lines) {
                      return r.network && !(in_equilibrium(r) && r.network->heights == Heights::graded);
                  }};

Stage const channels{"channels", usual, [](R r, Lines) { return is_around(r) && in_equilibrium(r); }};
Stage const fill_in_equilibrium{"fill", 2.0, [](R r, Lines) { return is_around(r) && in_equilibrium(r); }};
Stage const scatter{"scatter", usual, [](R r, Lines) { return is_around(r) && r.skeleton && r.skeleton->scatter > 0; }};
Stage const ridge{"ridge", usual, [](R r, Lines) { return is_around(r) && has_ridges(r); }};
Stage const tin{"tin", usual, [](R r, Lines) { return is_around(r) && needs_tin(r); }};
Stage const fill_dilated{"fill", 1.0, [](R r, Lines) { return is_around(r) && r.surface->method == Method::dilate; }};
Stage const fill{"fill", 0.8,
                 [](R r, Lines) { return is_around(r) && !in_equilibrium(r) && r.surface->method != Method::dilate; }};

Stage const land{"land", usual, [](R r, Lines) { return is_alone(r); }};
Stage const detail{"detail", usual, [](R r, Lines) { return is_alone(r) && levels_of(r) > 0; }};
Stage const project{"project", 20.0, [](R r, Lines) { return is_alone(r) && r.statistics.has_value(); }};

Stage const blend{"blend", 0.7, [](R r, Lines) { return has_surface(r) && !r.patches.empty(); }};
Stage const carve{"carve", 0.7, [](R r, Lines) {
                      return r.surface &&
                             r.surface->drain.value_or(flow::Conditioning::none) != flow::Conditioning::none;
                  }};
Stage const drain{"drain", usual, [](R r, Lines) { return has_surface(r); }};
Stage const valleys{"valleys", usual, [](R r, Lines) { return is_around(r) && r.network->fill_space; }};
Stage const measure{"measure", usual, [](R r, Lines) { return has_surface(r); }};
Stage const catchments{"catchments", usual, [](R r, Lines) {
                           return is_around(r) && r.output.catchments && r.output.has(OutputFiles::catchments);
                       }};
Stage const certify{"certify", usual, [](R r, Lines) { return is_around(r); }};
Stage const ridges{"ridges", usual, [](R r, Lines) {
                       return is_around(r) && (has_ridges(r) || (r.skeleton && !r.skeleton->ridge_lines.empty()));
                   }};
Stage const areas{"areas", usual, [](R r, Lines) {
                      return has_surface(r) && r.output.accumulation && r.output.has(OutputFiles::areas);
                  }};
Stage const laws{"laws", usual, [](R r, Lines) { return has_surface(r); }};
Stage const relief{"relief", 0.7, [](R r, Lines) { return has_surface(r); }};
Stage const check{"check", usual, [](R r, Lines) { return r.network.has_value(); }};
Stage const compare{"compare", usual, [](R r, Lines) { return !r.output.against.empty(); }};

} // namespace stage

std::span<Stage const* const> all_stages() {
    using namespace stage;
    static constexpr Stage const* in_order[] = {
        &raster,  &read,   &shape, &grow,         &thin,    &trace,    &embed,
        &adopt,   &sea,    &prune, &meander,      &raise,   &channels, &fill_in_equilibrium,
        &scatter, &ridge,  &tin,   &fill_dilated, &fill,    &land,     &detail,
        &project, &blend,  &carve, &drain,        &valleys, &measure,  &catchments,
        &certify, &ridges, &areas, &laws,         &relief,  &check,    &compare};
    return in_order;
}

std::vector<Stage const*> stages_of(Plan const& plan) {
    std::vector<Stage const*> found;
    for (Stage const* const one : all_stages()) {
        if (one->runs(plan.recipe, plan.lines)) {
            found.insert(found.end(), one == &stage::blend ? plan.recipe.patches.size() : 1, one);
        }
    }
    return found;
}

} // namespace thalweg::recipe
