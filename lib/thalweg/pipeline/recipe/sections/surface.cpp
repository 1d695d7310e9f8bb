// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

namespace thalweg::pipeline {

namespace {

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

} // namespace

Rows<SurfaceRecipe> surface_keys() {
    return joined<SurfaceRecipe>({method_keys(), inside("", &SurfaceRecipe::dilate, dilation_keys()), mask_keys(),
                                  inside("", &SurfaceRecipe::equilibrium, equilibrium_keys()), drain_keys(),
                                  tolerance_keys(), inside("", &SurfaceRecipe::diffuse, diffusion_keys()),
                                  interpolation_keys(), inside("", &SurfaceRecipe::regress, regression_keys())});
}

} // namespace thalweg::pipeline
