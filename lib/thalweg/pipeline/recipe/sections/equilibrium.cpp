// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

namespace thalweg::pipeline {

namespace {

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

} // namespace

Rows<EquilibriumRecipe> equilibrium_keys() {
    return joined<EquilibriumRecipe>({slope_keys(), rock_keys(), ground_keys()});
}

} // namespace thalweg::pipeline
