// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg::pipeline {

namespace {

bool is_near(Pair const& p) {
    return std::fabs(p[0]) <= 1e9 && std::fabs(p[1]) <= 1e9;
}

bool is_window(Quad const& q) {
    bool const whole =
        std::all_of(q.begin(), q.end(), [](double x) { return x >= 0.0 && x <= 1e6 && x == std::floor(x); });
    return whole && q[2] >= 1.0 && q[3] >= 1.0;
}

} // namespace

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
