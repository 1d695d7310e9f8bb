// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/around_rivers.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/network/order/streams.hpp>
#include <thalweg/pipeline/make/internal/land.hpp>
#include <thalweg/pipeline/make/internal/land_in_equilibrium.hpp>
#include <thalweg/pipeline/plan/internal/read_cells.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_asks.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/midpoint_inverse.hpp>
#include <thalweg/skeleton/ridges.hpp>
#include <thalweg/skeleton/scatter_between.hpp>
#include <thalweg/surface/diffusion/diffuse.hpp>
#include <thalweg/surface/diffusion/harmonic.hpp>
#include <thalweg/surface/dilation/dilate_over.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

namespace thalweg::pipeline {

namespace {

std::vector<Vec3> in_space(std::vector<Vec2> const& line, std::vector<double> const& z) {
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < line.size(); ++i) {
        out.push_back({line[i].x, line[i].y, z[i]});
    }
    return out;
}

/// The land with ridges between its streams.
DrawnTerrain with_ridges(DrawnTerrain drawn, Diary& diary, Run const& run) {
    SkeletonRecipe const& wanted = *drawn.recipe.skeleton;
    skeleton::RidgesParams params;
    params.method = wanted.ridges == Ridges::voronoi ? skeleton::RidgesParams::Method::voronoi
                                                     : skeleton::RidgesParams::Method::segments;
    params.gain = wanted.ridge_gain;
    params.farthest_m = wanted.ridge_farthest_m;
    drawn.ridges = diary.stage("ridge", [&] {
        return skeleton::ridges(drawn.network, network::streams(drawn.network.plan, drawn.orders), drawn.grid, params,
                                run);
    });
    diary.say(fmt::format("{} ridges", drawn.ridges.lines.size()));
    return drawn;
}

/// Random points between the rivers, where the recipe asks for them.
skeleton::Scattered scattered(DrawnTerrain const& drawn, Mask const& inside, Diary& diary, Run const& run) {
    SkeletonRecipe const& wanted = *drawn.recipe.skeleton;
    skeleton::ScatterBetweenParams params;
    params.seed = drawn.recipe.seed;
    params.count = wanted.scatter;
    params.spacing_cells = wanted.spacing_cells;
    params.gain = wanted.ridge_gain;
    params.farthest_m = wanted.ridge_farthest_m;
    params.law = wanted.law;
    skeleton::Scattered points =
        diary.stage("scatter", [&] { return skeleton::scatter_between(drawn.valley, inside, params, run); });
    diary.say(fmt::format("{} points", points.points.points.size()));
    return points;
}

/// The triangles of points, rivers and ridges, whose lines are breaklines.
DrawnTerrain with_tin(DrawnTerrain drawn, FeaturePoints const& points, Diary& diary, Run const& run) {
    std::vector<std::vector<Vec3>> breaklines;
    for (ArcId a = 0; a < drawn.network.plan.arc_count(); ++a) {
        breaklines.push_back(in_space(drawn.network.plan.arc(a).line, drawn.network.arc_z[a]));
    }
    for (RidgeLine const& ridge : drawn.ridges.lines) {
        breaklines.push_back(ridge.line);
    }
    drawn.tin = diary.stage("tin", [&] { return geometry::triangulate(points.points, breaklines, run).tin; });
    diary.say(fmt::format("{} triangles of {} vertices", drawn.tin->triangles.size(), drawn.tin->vertices.size()));
    return drawn;
}

/// The cells the land has: those of the recipe's mask, or all; without the sea.
Mask inside_of(Recipe const& recipe, Mask const& land, Valley const& valley) {
    if (recipe.surface->mask.empty()) {
        return land.values().empty() ? Mask(valley.z.grid(), 1) : land;
    }
    Grid const& grid = valley.z.grid();
    Mask inside = read_mask_of_land(file_in(recipe, recipe.surface->mask), grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        inside[i] = inside[i] != 0 && (land.values().empty() || land[i] != 0) ? 1 : 0;
        if (inside[i] == 0 && !std::isnan(valley.z[i])) {
            Cell const c = grid.at(i);
            throw BadInput(fmt::format("surface.mask = \"{}\" leaves out cell ({}, {}), where a river runs",
                                       recipe.surface->mask, c.col, c.row));
        }
    }
    return inside;
}

/// Land over the skeleton's triangles. Valley cells keep their heights.
Raster<float> over_triangles(DrawnTerrain const& drawn, Run const& run) {
    Raster<float> land =
        surface::rasterise_tin(*drawn.tin, drawn.grid, {surface::RasteriseTinParams::Outside::nearest}, run);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        land[i] = std::isnan(drawn.valley.z[i]) ? land[i] : drawn.valley.z[i];
    }
    return land;
}

void warn_of_jumps(surface::Dilated const& drawn, surface::IncrementParams const& params, Run const& run) {
    auto const jumps = surface::increment_jumps(drawn.levels, params);
    if (!jumps.empty()) {
        run.say(fmt::format("warning: surface.increment = \"{}\" jumps from {:.3g} to {:.3g} at x = {:.4g}{}: slopes "
                            "break there",
                            params.increment, jumps[0].from, jumps[0].to, jumps[0].x,
                            jumps.size() > 1 ? fmt::format(", and {} times more", jumps.size() - 1) : ""));
    }
}

surface::Dilated dilated(DrawnTerrain const& drawn, Mask const& inside, Run const& run) {
    SurfaceRecipe const& wanted = *drawn.recipe.surface;
    bool const whole = wanted.mask.empty() && drawn.land.values().empty();
    if (wanted.base == Base::paper) { // without a mask by the closed form
        return whole ? surface::dilate(drawn.valley, wanted.dilate, run)
                     : surface::dilate(drawn.valley, inside, wanted.dilate, run);
    }
    surface::HarmonicParams params;
    params.tolerance = wanted.tolerance.value_or(params.tolerance);
    Raster<float> const base =
        wanted.base == Base::tin ? over_triangles(drawn, run) : surface::harmonic(drawn.valley, inside, params, run);
    return whole ? surface::dilate_over(drawn.valley, base, wanted.dilate, run)
                 : surface::dilate_over(drawn.valley, base, inside, wanted.dilate, run);
}

/// What a land is diffused from: rivers, ridges, points, and what follows from them beside them.
Skeleton gathered(DrawnTerrain const& drawn, FeaturePoints const& points, Run const& run) {
    SkeletonRecipe const wanted = drawn.recipe.skeleton.value_or(SkeletonRecipe{});
    skeleton::DrawSkeletonParams params;
    params.noise.amplitude_m = wanted.ridge_noise_m;
    params.noise.wavelength_m = wanted.ridge_wavelength_m;
    params.noise.seed = drawn.recipe.seed;
    Skeleton skeleton = skeleton::draw_skeleton(drawn.valley, drawn.ridges, points, params, run).skeleton;
    if (wanted.midpoint_inverse_cells > 0.0) {
        skeleton = skeleton::midpoint_inverse(skeleton, {wanted.midpoint_inverse_cells}, run);
    }
    return skeleton;
}

/// A surface, and how it was solved for where it was.
struct Surface {
    surface::Dilated drawn;
    std::optional<SolverStory> diffusion = {};
};

Surface diffused(DrawnTerrain const& drawn, FeaturePoints const& points, Mask const& inside, Run const& run) {
    surface::DiffuseParams params = drawn.recipe.surface->diffuse;
    params.seed = drawn.recipe.seed;
    params.tolerance = drawn.recipe.surface->tolerance.value_or(params.tolerance);
    surface::Diffused land = surface::diffuse(gathered(drawn, points, run), inside, params, run);
    Surface made;
    made.drawn.dem = std::move(land.dem);
    made.diffusion = SolverStory{land.iterations, land.residual};
    return made;
}

/// Adds fractal detail to land with rivers: none in the valleys, all of it some cells away.
DrawnTerrain with_detail_beside_rivers(DrawnTerrain drawn, Run const& run) {
    constexpr double near_cells = 8.0; // within which detail grows from nothing to two thirds
    if (levels_of(drawn.recipe) == 0) {
        return drawn;
    }
    Detailed const detail = detail_alone(std::move(drawn.recipe), drawn.grid, run);
    drawn.recipe = detail.recipe;
    Raster<float> const& noise = detail.land;
    Raster<float>& dem = drawn.surface->dem;
    surface::Expansion const expansion = surface::expand(drawn.valley, run);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        double const share = 1.0 - portable::exp(-static_cast<double>(expansion.level[i]) / near_cells);
        dem[i] = static_cast<float>(static_cast<double>(dem[i]) + share * static_cast<double>(noise[i]));
    }
    return drawn;
}

Surface surface_of(DrawnTerrain const& drawn, FeaturePoints const& points, Mask const& inside, Run const& run) {
    SurfaceRecipe const& wanted = *drawn.recipe.surface;
    if (wanted.method == Method::tin) {
        Surface made;
        made.drawn.dem = over_triangles(drawn, run);
        for (std::int64_t i = 0; i < inside.cells(); ++i) {
            if (inside[i] == 0) {
                made.drawn.dem[i] = std::numeric_limits<float>::quiet_NaN();
            }
        }
        return made;
    }
    return wanted.method == Method::diffuse ? diffused(drawn, points, inside, run)
                                            : Surface{dilated(drawn, inside, run)};
}

/// Whether the slopes rise as high above their rivers as it was asked.
std::vector<Check> relief_checks(DrawnTerrain const& drawn) {
    constexpr double allowed = 0.01;
    double const asked = drawn.recipe.surface->dilate.relief_m;
    if (!(asked > 0.0)) {
        return {};
    }
    double const error = std::fabs(drawn.surface->rise_m / asked - 1.0);
    return {{"relief_error", error, allowed, error <= allowed}};
}

std::string about(DrawnTerrain const& drawn) {
    SurfaceRecipe const& wanted = *drawn.recipe.surface;
    switch (wanted.method) {
    case Method::dilate: return fmt::format("{}, {} levels", wanted.dilate.increment.increment, drawn.surface->levels);
    case Method::diffuse: return fmt::format("diffused, {} iterations", drawn.diffusion->iterations);
    case Method::equilibrium:
    case Method::tin:
    case Method::regress: break;
    }
    return "over triangles";
}

} // namespace

DrawnTerrain without_land(Rivers const& rivers) {
    DrawnTerrain drawn;
    drawn.recipe = rivers.recipe;
    drawn.grid = rivers.grid;
    drawn.land = rivers.land;
    drawn.network = rivers.network;
    drawn.orders = rivers.orders;
    drawn.streams = rivers.streams;
    drawn.types = rivers.types;
    drawn.valley = rivers.valley;
    return drawn;
}

DrawnTerrain draw_around_rivers(Rivers const& rivers, FeaturePoints const& given, Diary& diary, Run const& run) {
    DrawnTerrain drawn = without_land(rivers);
    bool const balanced = in_equilibrium(rivers.recipe);
    Mask inside;
    if (balanced) { // whose rivers have their heights from it
        drawn = draw_in_equilibrium(std::move(drawn), rivers.story.heights_of_file, diary, run);
    } else {
        inside = inside_of(drawn.recipe, drawn.land, drawn.valley);
    }
    std::optional<SkeletonRecipe> const skeleton = drawn.recipe.skeleton;
    std::optional<FeaturePoints> own;
    if (skeleton && skeleton->scatter > 0) {
        skeleton::Scattered found = scattered(drawn, inside, diary, run);
        drawn.checks.push_back(points_missing(found.missing, skeleton->scatter, run));
        own = std::move(found.points);
    }
    FeaturePoints const& points = own ? *own : given;
    if (skeleton && skeleton->ridges != Ridges::none) {
        drawn = with_ridges(std::move(drawn), diary, run);
    }
    SurfaceRecipe const wanted = *drawn.recipe.surface;
    bool const over_tin = wanted.method == Method::tin || (wanted.method == Method::dilate && wanted.base == Base::tin);
    if (over_tin || (skeleton && skeleton->tin)) {
        drawn = with_tin(std::move(drawn), points, diary, run);
    }
    if (!balanced) {
        Surface made = diary.stage("fill", [&] { return surface_of(drawn, points, inside, run); });
        drawn.surface = std::move(made.drawn);
        drawn.diffusion = made.diffusion;
        diary.say(fmt::format("{}x{}, {}", drawn.grid.width, drawn.grid.height, about(drawn)));
        if (wanted.method == Method::dilate) {
            std::vector<Check> const checks = relief_checks(drawn);
            drawn.checks.insert(drawn.checks.end(), checks.begin(), checks.end());
            warn_of_jumps(*drawn.surface, wanted.dilate.increment, run);
        }
    }
    return with_detail_beside_rivers(std::move(drawn), run);
}

} // namespace thalweg::pipeline
