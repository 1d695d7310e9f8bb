// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/recipe/internal/key_rows.hpp>

namespace thalweg::pipeline {
namespace {

/// Terrain that is interpolated between points, in a file or random.
Use from_points() {
    return without("network") && (without("statistics") || is("statistics.skeleton", {"points"}));
}

Use by_dilation() {
    return method_is({"dilate"});
}

/// Around rivers, or between points.
Use by_diffusion() {
    return is("surface.method", {"diffuse"}) && (with("network") || from_points());
}

/// Around rivers by a method that honours ridges and points.
Use beside_rivers() {
    return method_is({"diffuse", "tin"}) || (by_dilation() && is("surface.base", {"tin"}));
}

/// Heights of the highest or lowest cell are given.
Use has_extremes() {
    return given("statistics.max") || given("statistics.min");
}

Rows<SurfaceRecipe> method_keys() {
    return {
        choice("method", &SurfaceRecipe::method)
            .one_of({{"equilibrium", Method::equilibrium},
                     {"dilate", Method::dilate},
                     {"diffuse", Method::diffuse},
                     {"tin", Method::tin},
                     {"regress", Method::regress}})
            .used(with("network") || from_points())
            .means("how the terrain is made: by landscape evolution around the rivers, by dilation from the valleys, "
                   "by diffusion between rivers, ridges and points, over a TIN, or by regression through points"),
        choice("base", &SurfaceRecipe::base)
            .one_of({{"harmonic", Base::harmonic}, {"paper", Base::paper}, {"tin", Base::tin}})
            .used(by_dilation())
            .means("heights that slopes rise from: a harmonic surface through the rivers, the nearest valley cell as "
                   "published, or the TIN of the rivers"),
    };
}

Rows<SurfaceRecipe> mask_keys() {
    return {
        file("mask", &SurfaceRecipe::mask)
            .used(with("network") || (from_points() && without("statistics")))
            .means("raster on the grid: cells with 0 or no data get no height"),
    };
}

Rows<SurfaceRecipe> drain_keys() {
    using flow::Conditioning;
    return {
        choice("drain", &SurfaceRecipe::drain)
            .one_of({{"auto", std::nullopt},
                     {"carve", Conditioning::carve},
                     {"fill", Conditioning::fill},
                     {"none", Conditioning::none}})
            .means("hydrological conditioning: confine channels, then breach or fill depressions; auto: carve where "
                   "there are rivers, else none"),
    };
}

Rows<SurfaceRecipe> tolerance_keys() {
    return {
        number("tolerance", &SurfaceRecipe::tolerance)
            .range({1e-12, 0.1})
            .used((by_dilation() && is("surface.base", {"harmonic"})) ||
                  (by_diffusion() && is("surface.diffusion", {"steady"})))
            .means("relative residual at which the harmonic base or the steady state is solved; left out: 1e-8, or "
                   "1e-10 of the steady state"),
    };
}

Rows<SurfaceRecipe> interpolation_keys() {
    return {
        choice("interpolation", &SurfaceRecipe::interpolation)
            .one_of({{"linear", Interpolation::linear}, {"natural", Interpolation::natural}})
            .used(from_points() && is("surface.method", {"tin"}))
            .means("linear in triangles, or natural neighbours"),
    };
}

Use no_relief() {
    return when("surface.relief = 0", [](Recipe const& r) { return r.surface && r.surface->dilate.relief_m <= 0.0; });
}

Use by_rough_rock() {
    return by_equilibrium() && above("surface.roughness", 0.0);
}

Rows<EquilibriumRecipe> slope_keys() {
    return {
        number("mean_slope", &EquilibriumRecipe::mean_slope_deg)
            .unit("degrees")
            .range({0, 60, left_open})
            .earlier(25.0)
            .used(by_equilibrium() && no_relief())
            .means("mean slope of the terrain; left out: 25, around rivers of a file less on cells above 30 m"),
        number("hillslope", &EquilibriumRecipe::hillslope_m)
            .unit("m")
            .range({0, 1e5})
            .earlier(0.0)
            .used(by_equilibrium())
            .means("length below which soil creep rounds the slopes; 0: one cell"),
        number("debris_area", &EquilibriumRecipe::debris_area_km2)
            .unit("km2")
            .range({0, 1e6})
            .used(by_equilibrium())
            .means("drainage area below which debris flows cut hillsides, whose slopes hardly depend on area"),
        number("floor_width", &EquilibriumRecipe::floor_width)
            .range({0, 1})
            .earlier(0.04)
            .used(by_equilibrium())
            .means(
                "width of valley floors: 0.0425 is 18 m where 1 km2 drains, in proportion; it grows with drainage area "
                "^ 0.42, up to 200 km2"),
    };
}

Rows<EquilibriumRecipe> rock_keys() {
    return {
        number("roughness", &EquilibriumRecipe::roughness)
            .range({0, 1})
            .earlier(0.4)
            .earlier(0.25)
            .used(by_equilibrium())
            .means("standard deviation of the logarithm of erodibility"),
        number("longest_wave", &EquilibriumRecipe::longest_wave_m)
            .unit("m")
            .range({0, 1e7, left_open})
            .used(by_rough_rock())
            .means("longest wavelength of that variation"),
        number("grain", &EquilibriumRecipe::grain)
            .range({1, 20})
            .used(by_rough_rock())
            .means("how many times as far rock of one kind reaches along its strike as across it; 1: no grain"),
        number("strike", &EquilibriumRecipe::strike_deg)
            .unit("degrees")
            .range({-360, 360})
            .used((by_rough_rock() && above("surface.grain", 1.0)) ||
                  (by_equilibrium() && is("surface.uplift_pattern", {"tilt", "blocks", "folds"})))
            .means("direction of the rock's grain, of faults and folds, clockwise from north; left out: by the seed"),
    };
}

Rows<EquilibriumRecipe> ground_keys() {
    using surface::Edge;
    using surface::UpliftPattern;
    return {
        choice("edge", &EquilibriumRecipe::edge)
            .one_of({{"auto", std::nullopt},
                     {"open", Edge::open},
                     {"closed", Edge::closed},
                     {"coast", Edge::coast},
                     {"mainland", Edge::mainland}})
            .used(by_equilibrium())
            .means("boundary condition: the terrain continues (open), all water goes to the rivers (closed), sea "
                   "(coast), or sea where the mask or coastlines say so and beyond the grid the terrain continues "
                   "(mainland); auto: mainland with coastlines of a river file, coast with other sea, else open"),
        number("region", &EquilibriumRecipe::region)
            .range({1, 5})
            .used(by_equilibrium() && is("surface.edge", {"auto", "open"}))
            .means(
                "with an open edge the large valleys are found on land wider than the grid by this factor, and rivers "
                "may enter it, unless they come from a file; 1: on the grid alone; left out: 3"),
        file("uplift", &EquilibriumRecipe::uplift)
            .used(by_equilibrium())
            .means("raster over the grid, values above 0; only ratios count"),
        choice("uplift_pattern", &EquilibriumRecipe::uplift_pattern)
            .one_of({{"none", std::nullopt},
                     {"tilt", UpliftPattern::tilt},
                     {"domes", UpliftPattern::domes},
                     {"blocks", UpliftPattern::blocks},
                     {"folds", UpliftPattern::folds}})
            .used(by_equilibrium())
            .means("how uplift varies over long distances, beside the raster: it grows across the strike (tilt), in "
                   "domes, in blocks between faults or in folds along the strike"),
        number("uplift_contrast", &EquilibriumRecipe::uplift_contrast)
            .range({1, 100})
            .used(by_equilibrium() && is("surface.uplift_pattern", {"tilt", "domes", "blocks", "folds"}))
            .means("greatest uplift of the pattern over the least"),
        number("uplift_wave", &EquilibriumRecipe::uplift_wave_m)
            .unit("m")
            .range({0, 1e7, left_open})
            .used(by_equilibrium() && is("surface.uplift_pattern", {"domes", "blocks", "folds"}))
            .means("distance of domes, width of blocks, wavelength of folds"),
        file("erodibility", &EquilibriumRecipe::erodibility)
            .used(by_equilibrium())
            .means("raster over the grid, values above 0, or polygons with a field erodibility (1 elsewhere); only "
                   "ratios count"),
        file("lakes", &EquilibriumRecipe::lakes).used(by_equilibrium()).means("polygons of lakes"),
        number("lake_share", &EquilibriumRecipe::lake_share)
            .range({0, 1})
            .used(by_equilibrium())
            .means("share of the reaches with enough water that run through a lake"),
    };
}

/// Says what is wrong with it.
void require_increment(Value const& v) {
    surface::increments(1, {as_text(v)});
}

Rows<EquilibriumRecipe> equilibrium_keys() {
    return joined<EquilibriumRecipe>({slope_keys(), rock_keys(), ground_keys()});
}

Rows<surface::DilateParams> dilation_keys() {
    using surface::DilateParams;
    using surface::IncrementParams;
    using surface::Metric;
    return {
        text("increment", &DilateParams::increment, &IncrementParams::increment)
            .form(fmt::format("{} | an expression in x", fmt::join(surface::increment_names(), " | ")))
            .suggests(surface::increment_names())
            .checked(require_increment)
            .used(by_dilation())
            .means("height increment dh of the x-th dilation"),
        choice("metric", &DilateParams::metric)
            .one_of({{"cityblock", Metric::cityblock}, {"euclid", Metric::euclid}})
            .used(by_dilation())
            .means("distance to the valley: over 4 neighbours as published, or Euclidean"),
        number("relief", &DilateParams::relief_m)
            .unit("m")
            .range({0, 1e5})
            .used(method_is({"equilibrium", "dilate"}))
            .means("equilibrium: height from the lowest to the highest cell, 0: see mean_slope; dilate: greatest sum "
                   "of the increments, 0: published units times the cell size"),
        yes_no("allow_negative", &DilateParams::increment, &IncrementParams::allow_negative)
            .used(by_dilation())
            .means("keep increments below 0"),
    };
}

Rows<surface::DiffuseParams> diffusion_keys() {
    using surface::DiffuseParams;
    using surface::Diffusion;
    using surface::DiffusionStart;
    Use const by_sweeps = by_diffusion() && is("surface.diffusion", {"explicit"});
    return {
        choice("diffusion", &DiffuseParams::mode)
            .one_of({{"steady", Diffusion::steady}, {"explicit", Diffusion::explicit_sweeps}})
            .used(by_diffusion())
            .means("steady state, or a number of explicit sweeps as published"),
        number("sweeps", &DiffuseParams::iterations).range({0, 1e9}).used(by_sweeps).means("number of explicit sweeps"),
        choice("start", &DiffuseParams::start)
            .one_of({{"coarse", DiffusionStart::coarse}, {"zero", DiffusionStart::zero}})
            .used(by_sweeps)
            .means("where sweeps start: from the steady state of a coarser grid, or from 0 as published"),
        number("alpha", &DiffuseParams::alpha)
            .range({0, 0.25, left_open})
            .used(by_sweeps)
            .means("D dt / h^2 of an explicit sweep"),
        number("smoothing", &DiffuseParams::sigma_cells)
            .unit("cells")
            .range({0, 100})
            .used(by_diffusion())
            .means("sigma of Gaussian smoothing away from rivers, ridges and points; 0: none"),
        number("noise", &DiffuseParams::noise_m)
            .unit("m")
            .range({0, 1e5})
            .used(by_diffusion())
            .means("amplitude of noise far from rivers, ridges and points"),
    };
}

Rows<skeleton::RegressParams> regression_keys() {
    using skeleton::EighthTerm;
    using skeleton::RegressParams;
    using skeleton::SlopeMode;
    Use const by_regression = from_points() && is("surface.method", {"regress"});
    return {
        number("frequency_x", &RegressParams::frequency_x)
            .unit("cycles")
            .range({0, 1e4})
            .used(by_regression)
            .means("f_x over the grid's width; 0 leaves its term out"),
        number("frequency_y", &RegressParams::frequency_y)
            .unit("cycles")
            .range({0, 1e4})
            .used(by_regression)
            .means("f_y over the grid's height; 0 leaves its term out"),
        choice("slope_mode", &RegressParams::slope)
            .one_of({{"none", SlopeMode::none}, {"centre", SlopeMode::centre}, {"mean", SlopeMode::mean}})
            .used(by_regression)
            .means("what statistics.slope constrains: nothing, the slope at the grid's centre, or the mean square "
                   "slope"),
        choice("eighth_term", &RegressParams::eighth)
            .one_of({{"x2y2", EighthTerm::x2y2}, {"x3y", EighthTerm::x3y}})
            .used(by_regression)
            .means("the eighth term, whose exponents are illegible in Zhang, Liu and Li"),
    };
}

} // namespace

Rows<SurfaceRecipe> surface_keys() {
    return joined<SurfaceRecipe>({method_keys(), inside("", &SurfaceRecipe::dilate, dilation_keys()), mask_keys(),
                                  inside("", &SurfaceRecipe::equilibrium, equilibrium_keys()), drain_keys(),
                                  tolerance_keys(), inside("", &SurfaceRecipe::diffuse, diffusion_keys()),
                                  interpolation_keys(), inside("", &SurfaceRecipe::regress, regression_keys())});
}

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

namespace {

constexpr char const* place_words = "[z, column, row], columns and rows from 0 in the north-west";

bool is_place(Triple const& t) {
    return std::fabs(t[0]) <= 1e6 && t[1] >= 0.0 && t[2] >= 0.0 && t[1] < 1e6 && t[2] < 1e6 &&
           t[1] == std::floor(t[1]) && t[2] == std::floor(t[2]);
}

bool are_lengths(Pair const& p) {
    return p[0] > 0.0 && p[1] > 0.0 && p[0] <= 1e6 && p[1] <= 1e6;
}

Rows<StatisticsRecipe> target_keys() {
    return {
        number("mean", &StatisticsRecipe::mean)
            .unit("m")
            .range({-1e6, 1e6})
            .used(without("network"))
            .means("mean height"),
        number("std", &StatisticsRecipe::std)
            .unit("m")
            .range({0, 1e6, left_open})
            .used(without("network"))
            .means("standard deviation of heights"),
        numbers("max", &StatisticsRecipe::max)
            .unit("m")
            .form(place_words, is_place)
            .used(without("network"))
            .means("highest cell"),
        numbers("min", &StatisticsRecipe::min)
            .unit("m")
            .form(place_words, is_place)
            .used(without("network"))
            .means("lowest cell"),
        numbers("length", &StatisticsRecipe::length)
            .unit("cells")
            .form("[Lx, Ly] above 0", are_lengths)
            .used(without("network"))
            .means("correlation lengths: where the autocorrelation falls to 1/e"),
        number("slope", &StatisticsRecipe::slope)
            .unit("rad")
            .range({0, 1.5707, left_open})
            .used(without("network"))
            .means("mean arctan of the slope, in metres per cell"),
        number("dimension", &StatisticsRecipe::dimension)
            .range({2.01, 2.99})
            .used(without("network"))
            .means("fractal dimension"),
    };
}

Rows<StatisticsRecipe> prior_keys() {
    using skeleton::Falloff;
    Use const pulled = is("statistics.skeleton", {"separable", "markov3"});
    return {
        choice("skeleton", &StatisticsRecipe::skeleton)
            .one_of({{"grf", Prior::grf},
                     {"separable", Prior::separable},
                     {"markov3", Prior::markov3},
                     {"points", Prior::points}})
            .used(without("network"))
            .means("terrain that is matched to the statistics: a random field, or that of the points of [skeleton]"),
        number("reach", &StatisticsRecipe::reach_cells)
            .unit("cells")
            .range({0, 1e5})
            .used(without("network") && (pulled || above("skeleton.scatter", 0.0)) && has_extremes())
            .means("R: distance within which heights are pulled towards max and min"),
        choice("falloff", &StatisticsRecipe::falloff)
            .one_of({{"continuous", Falloff::continuous}, {"literal", Falloff::literal}})
            .used(without("network") && pulled && has_extremes())
            .means("pull at distance R: continuous to 0, or with a step as published"),
    };
}

} // namespace

Rows<StatisticsRecipe> statistics_keys() {
    return joined<StatisticsRecipe>({target_keys(), prior_keys()});
}

namespace {

using fractal::Stencil;

/// A number of neighbours, or a word.
Stencil stencil_of(Value const& v) {
    if (auto const* word = std::get_if<std::string>(&v)) {
        if (*word != "exact") {
            refuse_word(*word, {"4", "12", "16", "exact"});
        }
        return Stencil::exact;
    }
    switch (std::int64_t const n = as_integer(v)) {
    case 4: return Stencil::four;
    case 12: return Stencil::twelve;
    case 16: return Stencil::sixteen;
    default: throw BadParameter(fmt::format("{} is not one of 4, 12, 16, exact", n));
    }
}

Value value_of_stencil(Stencil s) {
    if (s == Stencil::exact) {
        return std::string("exact");
    }
    return std::int64_t{s == Stencil::four ? 4 : s == Stencil::twelve ? 12 : 16};
}

Use by_midpoint() {
    return is("detail.method", {"midpoint"});
}

Use few_neighbours() {
    return when("detail.stencil = 4, 12 or 16",
                [](Recipe const& r) { return r.detail && r.detail->midpoint.stencil != Stencil::exact; });
}

Rows<DetailRecipe> detail_method_keys() {
    return {
        choice("method", &DetailRecipe::method)
            .one_of({{"midpoint", DetailMethod::midpoint}, {"none", DetailMethod::none}})
            .used(has_surface())
            .means("fractal detail between every 2^levels-th cell"),
    };
}

Rows<fractal::MidpointParams> midpoint_keys() {
    using fractal::Adaptation;
    using fractal::MidpointParams;
    using fractal::Noise;
    Use const displaced = has_surface() && by_midpoint();
    return {
        number("levels", &MidpointParams::levels).range({1, 12}).used(displaced).means("how often cells are halved"),
        number("hurst", &MidpointParams::hurst)
            .range({0.05, 0.95})
            .used(displaced)
            .means("Hurst exponent H = 3 - fractal dimension; left out: estimated, with rivers 0.6"),
        number("sigma", &MidpointParams::sigma)
            .unit("m")
            .range({0, 1e6})
            .used(displaced)
            .means("root mean square difference of heights 2^levels cells apart; left out: estimated, with rivers it "
                   "must be given"),
        choice("stencil", &MidpointParams::stencil)
            .type("integer or text")
            .form("4 | 12 | 16 | exact")
            .suggests({"4", "12", "16", "exact"})
            .reads(stencil_of)
            .shows(value_of_stencil)
            .used(displaced)
            .means("number of neighbours that a height is interpolated from; 4 with the published variance; exact: a "
                   "fractional Brownian surface through all coarse cells, of which there are up to 2000"),
        choice("noise", &MidpointParams::noise)
            .one_of({{"normal", Noise::normal}, {"uniform", Noise::uniform}})
            .used(displaced && few_neighbours())
            .means("distribution of the displacements"),
        choice("adaptation", &MidpointParams::adaptation)
            .one_of({{"global", Adaptation::global}, {"local", Adaptation::local}})
            .used(by_midpoint() && few_neighbours() && without("network"))
            .means("one H and sigma for the grid, or local ones where they differ"),
    };
}

bool is_near(Pair const& p) {
    return std::fabs(p[0]) <= 1e9 && std::fabs(p[1]) <= 1e9;
}

bool is_window(Quad const& q) {
    bool const whole =
        std::all_of(q.begin(), q.end(), [](double x) { return x >= 0.0 && x <= 1e6 && x == std::floor(x); });
    return whole && q[2] >= 1.0 && q[3] >= 1.0;
}

} // namespace

Rows<DetailRecipe> detail_keys() {
    return joined<DetailRecipe>({detail_method_keys(), inside("", &DetailRecipe::midpoint, midpoint_keys())});
}

Rows<PatchRecipe> patch_keys() {
    return {
        file("source", &PatchRecipe::source)
            .kept_in("")
            .used(has_surface())
            .means("DEM whose relief is pasted; reprojected to the grid"),
        numbers("at", &PatchRecipe::at)
            .unit("m")
            .form("[x, y] within 1e9", is_near)
            .used(has_surface())
            .means("where its centre goes; left out: its own place, or the middle of the grid"),
        numbers("window", &PatchRecipe::window)
            .unit("cells")
            .form("[column, row, width, height], whole, from 0 in the north-west", is_window)
            .used(has_surface())
            .means("part of the source that is pasted; left out: all of it"),
        file("mask", &PatchRecipe::mask)
            .used(has_surface())
            .means("polygons, or a raster on the grid: what is pasted; \"\": all that the source covers"),
        number("rotate", &PatchRecipe::rotate_deg)
            .unit("degrees")
            .range({-360, 360})
            .used(has_surface())
            .means("rotation about its centre, counterclockwise"),
        number("scale", &PatchRecipe::scale).range({0, 1000, left_open}).used(has_surface()).means("scale in plan"),
        number("gain", &PatchRecipe::gain).range({-1000, 1000}).used(has_surface()).means("scale of its heights"),
        number("feather", &PatchRecipe::feather_cells)
            .unit("cells")
            .range({0, 1e5})
            .used(has_surface())
            .means("width of the blend from its slopes to those of the terrain, inside its edge"),
        choice("rivers", &PatchRecipe::rivers)
            .one_of({{"keep", PatchRivers::keep}, {"replace", PatchRivers::replace}})
            .used(with("network") && with("surface"))
            .means("whether rivers under it keep their heights"),
    };
}

} // namespace thalweg::pipeline
