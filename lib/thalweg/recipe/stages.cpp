// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/stages.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace thalweg::recipe {
namespace {

bool has_coastlines(RiverLines const& lines) {
    return std::ranges::any_of(lines.secondary, [](SecondaryLine const& line) { return line.cause == LeftOut::coast; });
}

constexpr double usual = 0.1; ///< [s] a million cells

Condition const over_tin = ask::is(&SurfaceRecipe::method, {Method::tin}) or
                           (by_dilation and ask::is(&SurfaceRecipe::base, {Base::tin})) or
                           ask::is(&SkeletonRecipe::tin, {true});
Condition const is_conditioned = ask::is(&SurfaceRecipe::drain, {flow::Conditioning::carve, flow::Conditioning::fill});

} // namespace

namespace stage {

using namespace ask;

Stage const raster{"raster", usual, 8, on_raster};
Stage const read{"read", usual, 5, from_lines or from_strokes};
Stage const shape{"shape", usual, 2, from_forest};
Stage const grow{"grow", usual, 9, from_cluster or by_tokunaga or from_forest};
Stage const thin{"thin", usual, 6, from_cluster};
Stage const trace{"trace", usual, 6, from_cluster};
Stage const embed{"embed", usual, 6, by_tokunaga and not given(&TokunagaRecipe::strokes)};
Stage const adopt{"adopt", usual, 6, from_lines};
Stage const sea{"sea",
                usual,
                6,
                from_lines and is(&LinesRecipe::coastlines, {Coastlines::sea}),
                {has_coastlines, "has coastlines"}};
Stage const prune{"prune", usual, 6, with_rivers};
Stage const meander{"meander", 0.7, 7, above(&NetworkRecipe::meander, 0) or grown_for_land};
Stage const raise{"raise", usual, 8,
                  with_rivers and (not is(&SurfaceRecipe::method, {Method::equilibrium}) or
                                   not is(&NetworkRecipe::heights, {Heights::graded}))};

Stage const channels{"channels", usual, 8, in_equilibrium};
Stage const fill_in_equilibrium{
    "fill", 2.0, 19, in_equilibrium and is(&NetworkRecipe::heights, {Heights::graded}) and not has(&Recipe::layers)};
Stage const fill_in_layers{"fill", 8.0, 30, // solved again until the metres of layers fit
                           in_layers and is(&NetworkRecipe::heights, {Heights::graded})};
Stage const fill_with_heights{"fill", 4.0, 31, // solved again until the metres of heights fit
                              in_equilibrium and not is(&NetworkRecipe::heights, {Heights::graded, Heights::file})};
Stage const fill_rebuilt{"fill", 2.0, 62, in_equilibrium and is(&NetworkRecipe::heights, {Heights::file})};
Stage const scatter{"scatter", usual, 12, around_rivers and above(&SkeletonRecipe::scatter, 0)};
Stage const ridge{"ridge", usual, 12, around_rivers and between_streams};
Stage const tin{"tin", usual, 12, around_rivers and over_tin};
Stage const fill_dilated{"fill", 1.0, 31, by_dilation};
Stage const fill{"fill", 0.8, 31,
                 around_rivers and not is(&SurfaceRecipe::method, {Method::equilibrium, Method::dilate})};

Stage const land{"land", usual, 10, not with_rivers};
Stage const detail{"detail", usual, 20, not with_rivers and is(&DetailRecipe::method, {DetailMethod::midpoint})};
Stage const project{"project", 20.0, 110, not with_rivers and has(&Recipe::statistics)};

Stage const blend{"blend", 0.7, 20, with_surface and has(&Recipe::patches)};
Stage const carve{"carve", 0.7, 17, is_conditioned};
Stage const drain{"drain", usual, 16, with_surface};
Stage const valleys{"valleys", usual, 16, around_rivers and is(&NetworkRecipe::fill_space, {true})};
Stage const measure{"measure", usual, 14, with_surface};
Stage const certify{"certify", usual, 16, around_rivers};
Stage const ridges{"ridges", usual, 24, around_rivers and (between_streams or given(&SkeletonRecipe::ridge_lines))};
Stage const areas{"areas", usual, 16,
                  with_surface and is(&OutputRecipe::accumulation, {true}) and writes(OutputFiles::areas)};
Stage const laws{"laws", usual, 15, with_surface};
Stage const relief{"relief", 0.7, 16, with_surface};
Stage const catchments{"catchments", usual, 16,
                       around_rivers and is(&OutputRecipe::catchments, {true}) and writes(OutputFiles::catchments)};
Stage const check{"check", usual, 16, with_rivers};
Stage const compare{"compare", usual, 20, given(&OutputRecipe::against)};

} // namespace stage

std::string Stage::runs_if() const {
    return lines.holds == nullptr ? when.text() : fmt::format("{} and its file {}", when.text(), lines.words);
}

std::span<Stage const* const> all_stages() {
    using namespace stage;
    static constexpr Stage const* in_order[] = {&raster,
                                                &read,
                                                &shape,
                                                &grow,
                                                &thin,
                                                &trace,
                                                &embed,
                                                &adopt,
                                                &sea,
                                                &prune,
                                                &meander,
                                                &raise,
                                                &channels,
                                                &fill_in_equilibrium,
                                                &fill_in_layers,
                                                &fill_with_heights,
                                                &fill_rebuilt,
                                                &scatter,
                                                &ridge,
                                                &tin,
                                                &fill_dilated,
                                                &fill,
                                                &land,
                                                &detail,
                                                &project,
                                                &blend,
                                                &carve,
                                                &drain,
                                                &valleys,
                                                &measure,
                                                &certify,
                                                &ridges,
                                                &areas,
                                                &laws,
                                                &relief,
                                                &catchments,
                                                &check,
                                                &compare};
    return in_order;
}

std::vector<Stage const*> stages_of(Recipe const& recipe, RiverLines const& lines) {
    std::vector<Stage const*> found;
    for (Stage const* const one : all_stages()) {
        if (one->runs(recipe, lines)) {
            found.insert(found.end(), one == &stage::blend ? recipe.patches.size() : 1, one);
        }
    }
    return found;
}

} // namespace thalweg::recipe
