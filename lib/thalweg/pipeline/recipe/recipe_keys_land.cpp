// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/key_kinds.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_sections.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/conditioning/condition.hpp>

#include <fmt/format.h>

namespace thalweg::pipeline {

void add_skeleton_keys(std::vector<Key>& keys) {
    keys.push_back(choice<Ridges>(
        "skeleton.ridges", {{"none", Ridges::none}, {"voronoi", Ridges::voronoi}, {"segments", Ridges::segments}},
        "ridges midway between streams: edges of the Voronoi diagram of points along them, or exact medial lines",
        in_skeleton<Ridges>([](SkeletonRecipe& s) -> Ridges& { return s.ridges; })));
    keys.push_back(number("skeleton.ridge_gain", "m/m", {0, 100},
                          "lambda_h: rise of a ridge above its rivers per metre of distance, and greatest rise of a "
                          "random point",
                          in_skeleton<double>([](SkeletonRecipe& s) -> double& { return s.ridge_gain; })));
    keys.push_back(number("skeleton.ridge_farthest", "m", {0, 1e7},
                          "d_max: distance from the rivers beyond which ridges and random points rise no more; 0: none",
                          in_skeleton<double>([](SkeletonRecipe& s) -> double& { return s.ridge_farthest_m; })));
    keys.push_back(number("skeleton.ridge_noise", "m", {0, 1e5}, "amplitude of noise along ridges, 0 at their ends",
                          in_skeleton<double>([](SkeletonRecipe& s) -> double& { return s.ridge_noise_m; })));
    keys.push_back(number("skeleton.ridge_wavelength", "m", {0, 1e7, true}, "longest wavelength of that noise",
                          in_skeleton<double>([](SkeletonRecipe& s) -> double& { return s.ridge_wavelength_m; })));
    keys.push_back(number(
        "skeleton.midpoint_inverse", "cells", {0, 1e6},
        "L: heights of cells up to this far from rivers, ridges and points by inverse midpoint displacement; 0: none",
        in_skeleton<double>([](SkeletonRecipe& s) -> double& { return s.midpoint_inverse_cells; })));
    keys.push_back(file("skeleton.points", "points with heights: CSV, XYZ, or a file of points (GeoPackage, ...)",
                        in_skeleton<std::string>([](SkeletonRecipe& s) -> std::string& { return s.points; })));
    keys.push_back(integer<std::int64_t>(
        "skeleton.scatter", "", {0, 1e7},
        "number of random points, between the rivers or, without [network], including the extremes of [statistics]",
        in_skeleton<std::int64_t>([](SkeletonRecipe& s) -> std::int64_t& { return s.scatter; })));
    keys.push_back(number("skeleton.spacing", "cells", {0, 1e5},
                          "minimum distance r between random points, and from them to rivers",
                          in_skeleton<double>([](SkeletonRecipe& s) -> double& { return s.spacing_cells; })));
    keys.push_back(choice<skeleton::HeightLaw>(
        "skeleton.law", {{"uniform", skeleton::HeightLaw::uniform}, {"normal", skeleton::HeightLaw::normal}},
        "distribution of the heights of random points; with [network], of their share of ridge_gain times the distance "
        "from the nearest river",
        in_skeleton<skeleton::HeightLaw>([](SkeletonRecipe& s) -> skeleton::HeightLaw& { return s.law; })));
    keys.push_back(choice<skeleton::Deviation>(
        "skeleton.deviation", {{"exact", skeleton::Deviation::exact}, {"printed", skeleton::Deviation::printed}},
        "deviation of random points: exactly statistics.std, or by equation 8 of Zhang, Liu and Li, heights "
        "uniform within statistics.std of the mean",
        in_skeleton<skeleton::Deviation>([](SkeletonRecipe& s) -> skeleton::Deviation& { return s.deviation; })));
    keys.push_back(choice<skeleton::Falloff>(
        "skeleton.falloff", {{"literal", skeleton::Falloff::literal}, {"continuous", skeleton::Falloff::continuous}},
        "pull of random points towards max and min at distance R: with a step as published, or continuous to 0",
        in_skeleton<skeleton::Falloff>([](SkeletonRecipe& s) -> skeleton::Falloff& { return s.falloff; })));
    keys.push_back(yes_no("skeleton.tin", "write the TIN of rivers and points: tin.2dm, tin.ply",
                          in_skeleton<bool>([](SkeletonRecipe& s) -> bool& { return s.tin; })));
}

namespace {

void add_diffusion_keys(std::vector<Key>& keys) {
    using surface::Diffusion;
    using surface::DiffusionStart;
    using MaybeNumber = std::optional<double>;
    keys.push_back(maybe("surface.tolerance", "", {1e-12, 0.1},
                         "relative residual at which the harmonic base or the steady state is solved; left out: 1e-8, "
                         "or 1e-10 of the steady state",
                         in_surface<MaybeNumber>([](SurfaceRecipe& s) -> MaybeNumber& { return s.tolerance; })));
    keys.push_back(choice<Diffusion>(
        "surface.diffusion", {{"steady", Diffusion::steady}, {"explicit", Diffusion::explicit_sweeps}},
        "steady state, or a number of explicit sweeps as published",
        in_surface<Diffusion>([](SurfaceRecipe& s) -> Diffusion& { return s.diffuse.mode; })));
    keys.push_back(integer<int>("surface.sweeps", "", {0, 1e9}, "number of explicit sweeps",
                                in_surface<int>([](SurfaceRecipe& s) -> int& { return s.diffuse.iterations; })));
    keys.push_back(choice<DiffusionStart>(
        "surface.start", {{"coarse", DiffusionStart::coarse}, {"zero", DiffusionStart::zero}},
        "where sweeps start: from the steady state of a coarser grid, or from 0 as published",
        in_surface<DiffusionStart>([](SurfaceRecipe& s) -> DiffusionStart& { return s.diffuse.start; })));
    keys.push_back(number("surface.alpha", "", {0, 0.25, true}, "D dt / h^2 of an explicit sweep",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.diffuse.alpha; })));
    keys.push_back(number("surface.smoothing", "cells", {0, 100},
                          "sigma of Gaussian smoothing away from rivers, ridges and points; 0: none",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.diffuse.sigma_cells; })));
    keys.push_back(number("surface.noise", "m", {0, 1e5}, "amplitude of noise far from rivers, ridges and points",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.diffuse.noise_m; })));
}

void add_equilibrium_keys(std::vector<Key>& keys) {
    using surface::Edge;
    using MaybeEdge = std::optional<Edge>;
    keys.push_back(maybe("surface.mean_slope", "degrees", {0, 60, true},
                         "mean slope of the terrain; left out: 25, around rivers of a file less on cells above 30 m",
                         in_surface<std::optional<double>>(
                             [](SurfaceRecipe& s) -> std::optional<double>& { return s.equilibrium.mean_slope_deg; })));
    keys.push_back(number("surface.hillslope", "m", {0, 1e5},
                          "length below which soil creep rounds the slopes, at least half a cell; 0: one cell",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.equilibrium.hillslope_m; })));
    keys.push_back(number("surface.floor_width", "", {0, 1},
                          "half the width of a valley floor in cells, divided by (drainage area in cells) ^ 0.4",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.equilibrium.floor_width; })));
    keys.push_back(number("surface.roughness", "", {0, 1}, "standard deviation of the logarithm of erodibility",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.equilibrium.roughness; })));
    keys.push_back(choice<MaybeEdge>(
        "surface.edge",
        {{"auto", std::nullopt},
         {"open", Edge::open},
         {"closed", Edge::closed},
         {"coast", Edge::coast},
         {"mainland", Edge::mainland}},
        "boundary condition: the terrain continues (open), all water goes to the rivers (closed), sea (coast), or sea "
        "where the mask or coastlines say so and beyond the grid the terrain continues (mainland); auto: mainland "
        "with coastlines of a river file, coast with other sea, else open",
        in_surface<MaybeEdge>([](SurfaceRecipe& s) -> MaybeEdge& { return s.equilibrium.edge; })));
    keys.push_back(
        file("surface.uplift", "raster over the grid, values above 0; only ratios count",
             in_surface<std::string>([](SurfaceRecipe& s) -> std::string& { return s.equilibrium.uplift; })));
    keys.push_back(file(
        "surface.erodibility",
        "raster over the grid, values above 0, or polygons with a field erodibility (1 elsewhere); only ratios count",
        in_surface<std::string>([](SurfaceRecipe& s) -> std::string& { return s.equilibrium.erodibility; })));
    keys.push_back(file("surface.lakes", "polygons of lakes",
                        in_surface<std::string>([](SurfaceRecipe& s) -> std::string& { return s.equilibrium.lakes; })));
    keys.push_back(number("surface.lake_share", "", {0, 1},
                          "share of the reaches with enough water that run through a lake",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.equilibrium.lake_share; })));
}

} // namespace

void add_surface_keys(std::vector<Key>& keys) {
    using skeleton::EighthTerm;
    using skeleton::SlopeMode;
    keys.push_back(choice<Method>(
        "surface.method",
        {{"equilibrium", Method::equilibrium},
         {"dilate", Method::dilate},
         {"diffuse", Method::diffuse},
         {"tin", Method::tin},
         {"regress", Method::regress}},
        "how the terrain is made: by landscape evolution around the rivers, by dilation from the valleys, by diffusion "
        "between rivers, ridges and points, over a TIN, or by regression through points",
        in_surface<Method>([](SurfaceRecipe& s) -> Method& { return s.method; })));
    keys.push_back(choice<Base>("surface.base",
                                {{"harmonic", Base::harmonic}, {"paper", Base::paper}, {"tin", Base::tin}},
                                "heights that slopes rise from: a harmonic surface through the rivers, the nearest "
                                "valley cell as published, or the TIN of the rivers",
                                in_surface<Base>([](SurfaceRecipe& s) -> Base& { return s.base; })));
    {
        Key key = text(
            "surface.increment", "", "height increment dh of the x-th dilation",
            in_surface<std::string>([](SurfaceRecipe& s) -> std::string& { return s.dilate.increment.increment; }));
        key.help.choices = surface::increment_names();
        key.help.range = fmt::format("{} | an expression in x", fmt::join(key.help.choices, " | "));
        auto const put = key.put;
        key.put = [put](Recipe& r, Value const& v) {
            surface::increments(1, {as_text(v)}); // says what is wrong with it
            put(r, v);
        };
        keys.push_back(std::move(key));
    }
    keys.push_back(choice<surface::Metric>(
        "surface.metric", {{"cityblock", surface::Metric::cityblock}, {"euclid", surface::Metric::euclid}},
        "distance to the valley: over 4 neighbours as published, or Euclidean",
        in_surface<surface::Metric>([](SurfaceRecipe& s) -> surface::Metric& { return s.dilate.metric; })));
    keys.push_back(number("surface.relief", "m", {0, 1e5},
                          "equilibrium: height from the lowest to the highest cell, 0: see mean_slope; dilate: "
                          "greatest sum of the increments, 0: published units times the cell size",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.dilate.relief_m; })));
    keys.push_back(
        yes_no("surface.allow_negative", "keep increments below 0",
               in_surface<bool>([](SurfaceRecipe& s) -> bool& { return s.dilate.increment.allow_negative; })));
    keys.push_back(file("surface.mask", "raster on the grid: cells with 0 or no data get no height",
                        in_surface<std::string>([](SurfaceRecipe& s) -> std::string& { return s.mask; })));
    add_equilibrium_keys(keys);
    using MaybeDrain = std::optional<flow::Conditioning>;
    keys.push_back(choice<MaybeDrain>("surface.drain",
                                      {{"auto", std::nullopt},
                                       {"carve", flow::Conditioning::carve},
                                       {"fill", flow::Conditioning::fill},
                                       {"none", flow::Conditioning::none}},
                                      "hydrological conditioning: confine channels, then breach or fill depressions; "
                                      "auto: carve where there are rivers, else none",
                                      in_surface<MaybeDrain>([](SurfaceRecipe& s) -> MaybeDrain& { return s.drain; })));
    add_diffusion_keys(keys);
    keys.push_back(choice<Interpolation>(
        "surface.interpolation", {{"linear", Interpolation::linear}, {"natural", Interpolation::natural}},
        "linear in triangles, or natural neighbours",
        in_surface<Interpolation>([](SurfaceRecipe& s) -> Interpolation& { return s.interpolation; })));
    keys.push_back(number("surface.frequency_x", "cycles", {0, 1e4}, "f_x over the grid's width; 0 leaves its term out",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.regress.frequency_x; })));
    keys.push_back(number("surface.frequency_y", "cycles", {0, 1e4},
                          "f_y over the grid's height; 0 leaves its term out",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.regress.frequency_y; })));
    keys.push_back(choice<SlopeMode>(
        "surface.slope_mode", {{"none", SlopeMode::none}, {"centre", SlopeMode::centre}, {"mean", SlopeMode::mean}},
        "what statistics.slope constrains: nothing, the slope at the grid's centre, or the mean square slope",
        in_surface<SlopeMode>([](SurfaceRecipe& s) -> SlopeMode& { return s.regress.slope; })));
    keys.push_back(
        choice<EighthTerm>("surface.eighth_term", {{"x2y2", EighthTerm::x2y2}, {"x3y", EighthTerm::x3y}},
                           "the eighth term, whose exponents are illegible in Zhang, Liu and Li",
                           in_surface<EighthTerm>([](SurfaceRecipe& s) -> EighthTerm& { return s.regress.eighth; })));
}

void add_statistics_keys(std::vector<Key>& keys) {
    using skeleton::Falloff;
    using MaybeNumber = std::optional<double>;
    using MaybeTriple = std::optional<Triple>;
    auto const is_place = [](Triple const& t) {
        return std::fabs(t[0]) <= 1e6 && t[1] >= 0.0 && t[2] >= 0.0 && t[1] < 1e6 && t[2] < 1e6 &&
               t[1] == std::floor(t[1]) && t[2] == std::floor(t[2]);
    };
    keys.push_back(maybe("statistics.mean", "m", {-1e6, 1e6}, "mean height",
                         in_statistics<MaybeNumber>([](StatisticsRecipe& s) -> MaybeNumber& { return s.mean; })));
    keys.push_back(maybe("statistics.std", "m", {0, 1e6, true}, "standard deviation of heights",
                         in_statistics<MaybeNumber>([](StatisticsRecipe& s) -> MaybeNumber& { return s.std; })));
    keys.push_back(numbers<Triple>(
        "statistics.max", "three numbers", "[z, column, row], columns and rows from 0 in the north-west", "m",
        "highest cell", in_statistics<MaybeTriple>([](StatisticsRecipe& s) -> MaybeTriple& { return s.max; }),
        is_place));
    keys.push_back(numbers<Triple>(
        "statistics.min", "three numbers", "[z, column, row], columns and rows from 0 in the north-west", "m",
        "lowest cell", in_statistics<MaybeTriple>([](StatisticsRecipe& s) -> MaybeTriple& { return s.min; }),
        is_place));
    keys.push_back(numbers<Pair>(
        "statistics.length", "two numbers", "[Lx, Ly] above 0", "cells",
        "correlation lengths: where the autocorrelation falls to 1/e",
        in_statistics<std::optional<Pair>>([](StatisticsRecipe& s) -> std::optional<Pair>& { return s.length; }),
        [](Pair const& p) { return p[0] > 0.0 && p[1] > 0.0 && p[0] <= 1e6 && p[1] <= 1e6; }));
    keys.push_back(maybe("statistics.slope", "rad", {0, 1.5707, true}, "mean arctan of the slope, in metres per cell",
                         in_statistics<MaybeNumber>([](StatisticsRecipe& s) -> MaybeNumber& { return s.slope; })));
    keys.push_back(maybe("statistics.dimension", "", {2.01, 2.99}, "fractal dimension",
                         in_statistics<MaybeNumber>([](StatisticsRecipe& s) -> MaybeNumber& { return s.dimension; })));
    keys.push_back(choice<Prior>(
        "statistics.skeleton",
        {{"grf", Prior::grf}, {"separable", Prior::separable}, {"markov3", Prior::markov3}, {"points", Prior::points}},
        "terrain that is matched to the statistics: a random field, or that of the points of [skeleton]",
        in_statistics<Prior>([](StatisticsRecipe& s) -> Prior& { return s.skeleton; })));
    keys.push_back(number("statistics.reach", "cells", {0, 1e5},
                          "R: distance within which heights are pulled towards max and min",
                          in_statistics<double>([](StatisticsRecipe& s) -> double& { return s.reach_cells; })));
    keys.push_back(choice<Falloff>("statistics.falloff",
                                   {{"continuous", Falloff::continuous}, {"literal", Falloff::literal}},
                                   "pull at distance R: continuous to 0, or with a step as published",
                                   in_statistics<Falloff>([](StatisticsRecipe& s) -> Falloff& { return s.falloff; })));
}

namespace {

/// The value of detail.stencil: a number of neighbours, or a word.
fractal::Stencil stencil_of(Value const& v) {
    using fractal::Stencil;
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

} // namespace

void add_detail_keys(std::vector<Key>& keys) {
    using fractal::Adaptation;
    using fractal::Noise;
    using fractal::Stencil;
    using MaybeNumber = std::optional<double>;
    keys.push_back(
        choice<DetailMethod>("detail.method", {{"midpoint", DetailMethod::midpoint}, {"none", DetailMethod::none}},
                             "fractal detail between every 2^levels-th cell",
                             in_detail<DetailMethod>([](DetailRecipe& d) -> DetailMethod& { return d.method; })));
    keys.push_back(integer<int>("detail.levels", "", {1, 12}, "how often cells are halved",
                                in_detail<int>([](DetailRecipe& d) -> int& { return d.midpoint.levels; })));
    keys.push_back(maybe("detail.hurst", "", {0.05, 0.95},
                         "Hurst exponent H = 3 - fractal dimension; left out: estimated, with rivers 0.6",
                         in_detail<MaybeNumber>([](DetailRecipe& d) -> MaybeNumber& { return d.midpoint.hurst; })));
    keys.push_back(maybe("detail.sigma", "m", {0, 1e6},
                         "root mean square difference of heights 2^levels cells apart; left out: estimated, with "
                         "rivers it must be given",
                         in_detail<MaybeNumber>([](DetailRecipe& d) -> MaybeNumber& { return d.midpoint.sigma; })));
    {
        Key key;
        key.help = {"detail.stencil",
                    "integer or text",
                    "4 | 12 | 16 | exact",
                    "",
                    "",
                    "number of neighbours that a height is interpolated from; 4 with the published variance; exact: a "
                    "fractional Brownian surface through all coarse cells, of which there are up to 2000",
                    {"4", "12", "16", "exact"}};
        key.put = [](Recipe& r, Value const& v) {
            Stencil const stencil = stencil_of(v);
            if (!r.detail) {
                r.detail.emplace();
            }
            r.detail->midpoint.stencil = stencil;
        };
        key.take = [](Recipe const& r) -> std::optional<Value> {
            if (!r.detail) {
                return std::nullopt;
            }
            Stencil const s = r.detail->midpoint.stencil;
            if (s == Stencil::exact) {
                return std::string("exact");
            }
            return std::int64_t{s == Stencil::four ? 4 : s == Stencil::twelve ? 12 : 16};
        };
        keys.push_back(std::move(key));
    }
    keys.push_back(choice<Noise>("detail.noise", {{"normal", Noise::normal}, {"uniform", Noise::uniform}},
                                 "distribution of the displacements",
                                 in_detail<Noise>([](DetailRecipe& d) -> Noise& { return d.midpoint.noise; })));
    keys.push_back(choice<Adaptation>(
        "detail.adaptation", {{"global", Adaptation::global}, {"local", Adaptation::local}},
        "one H and sigma for the grid, or local ones where they differ",
        in_detail<Adaptation>([](DetailRecipe& d) -> Adaptation& { return d.midpoint.adaptation; })));
}

} // namespace thalweg::pipeline
