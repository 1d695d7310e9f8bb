// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

namespace thalweg::pipeline {

namespace {

Use with_ridges() {
    return beside_rivers() && is("skeleton.ridges", {"voronoi", "segments"});
}

Use with_noise() {
    return method_is({"diffuse"}) && is("skeleton.ridges", {"voronoi", "segments"});
}

/// Points between rivers, or instead of them.
Use honours_points() {
    return from_points() || beside_rivers();
}

Use scatters() {
    return above("skeleton.scatter", 0.0);
}

Use no_scatter() {
    return when("skeleton.scatter = 0", [](Recipe const& r) { return !r.skeleton || r.skeleton->scatter == 0; });
}

Use tin_of_points() {
    return from_points() && (without("surface") || is("surface.method", {"tin"}));
}

Rows<SkeletonRecipe> ridge_keys() {
    Use const rises = with_ridges() || (beside_rivers() && scatters());
    return {
        choice("ridges", &SkeletonRecipe::ridges)
            .one_of({{"none", Ridges::none}, {"voronoi", Ridges::voronoi}, {"segments", Ridges::segments}})
            .used(beside_rivers())
            .means("ridges midway between streams: edges of the Voronoi diagram of points along them, or exact medial "
                   "lines"),
        number("ridge_gain", &SkeletonRecipe::ridge_gain)
            .unit("m/m")
            .range({0, 100})
            .used(rises)
            .means("lambda_h: rise of a ridge above its rivers per metre of distance, and greatest rise of a random "
                   "point"),
        number("ridge_farthest", &SkeletonRecipe::ridge_farthest_m)
            .unit("m")
            .range({0, 1e7})
            .used(rises && above("skeleton.ridge_gain", 0.0))
            .means("d_max: distance from the rivers beyond which ridges and random points rise no more; 0: none"),
        number("ridge_noise", &SkeletonRecipe::ridge_noise_m)
            .unit("m")
            .range({0, 1e5})
            .used(with_noise())
            .means("amplitude of noise along ridges, 0 at their ends"),
        number("ridge_wavelength", &SkeletonRecipe::ridge_wavelength_m)
            .unit("m")
            .range({0, 1e7, left_open})
            .used(with_noise() && above("skeleton.ridge_noise", 0.0))
            .means("longest wavelength of that noise"),
        number("midpoint_inverse", &SkeletonRecipe::midpoint_inverse_cells)
            .unit("cells")
            .range({0, 1e6})
            .used(method_is({"diffuse"}))
            .means("L: heights of cells up to this far from rivers, ridges and points by inverse midpoint "
                   "displacement; 0: none"),
    };
}

Rows<SkeletonRecipe> point_keys() {
    using skeleton::Deviation;
    using skeleton::Falloff;
    using skeleton::HeightLaw;
    return {
        file("points", &SkeletonRecipe::points)
            .used(honours_points() && no_scatter())
            .means("points with heights: CSV, XYZ, or a file of points (GeoPackage, ...)"),
        number("scatter", &SkeletonRecipe::scatter)
            .range({0, 1e7})
            .used(honours_points() && not_given("skeleton.points"))
            .means("number of random points, between the rivers or, without [network], including the extremes of "
                   "[statistics]"),
        number("spacing", &SkeletonRecipe::spacing_cells)
            .unit("cells")
            .range({0, 1e5})
            .used(honours_points() && scatters())
            .means("minimum distance r between random points, and from them to rivers"),
        choice("law", &SkeletonRecipe::law)
            .one_of({{"uniform", HeightLaw::uniform}, {"normal", HeightLaw::normal}})
            .used(honours_points() && scatters())
            .means("distribution of the heights of random points; with [network], of their share of ridge_gain times "
                   "the distance from the nearest river"),
        choice("deviation", &SkeletonRecipe::deviation)
            .one_of({{"exact", Deviation::exact}, {"printed", Deviation::printed}})
            .used(from_points() && scatters())
            .means("deviation of random points: exactly statistics.std, or by equation 8 of Zhang, Liu and Li, heights "
                   "uniform within statistics.std of the mean"),
        choice("falloff", &SkeletonRecipe::falloff)
            .one_of({{"literal", Falloff::literal}, {"continuous", Falloff::continuous}})
            .used(from_points() && scatters() && above("statistics.reach", 0.0) && has_extremes())
            .means("pull of random points towards max and min at distance R: with a step as published, or continuous "
                   "to 0"),
        yes_no("tin", &SkeletonRecipe::tin)
            .used((with("network") && with("surface")) || tin_of_points())
            .means("write the TIN of rivers and points: tin.2dm, tin.ply"),
    };
}

} // namespace

Rows<SkeletonRecipe> skeleton_keys() {
    return joined<SkeletonRecipe>({ridge_keys(), point_keys()});
}

} // namespace thalweg::pipeline
