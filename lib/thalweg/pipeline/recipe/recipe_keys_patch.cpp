// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/key_kinds.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_sections.hpp>

#include <algorithm>

namespace thalweg::pipeline {

void add_patch_keys(std::vector<Key>& keys) {
    using MaybePair = std::optional<Pair>;
    using MaybeQuad = std::optional<Quad>;
    keys.push_back(file("patch.source", "DEM whose relief is pasted; reprojected to the grid",
                        in_patch<std::string>([](PatchRecipe& p) -> std::string& { return p.source; })));
    keys.push_back(numbers<Pair>("patch.at", "two numbers", "[x, y] within 1e9", "m",
                                 "where its centre goes; left out: its own place, or the middle of the grid",
                                 in_patch<MaybePair>([](PatchRecipe& p) -> MaybePair& { return p.at; }),
                                 [](Pair const& p) { return std::fabs(p[0]) <= 1e9 && std::fabs(p[1]) <= 1e9; }));
    keys.push_back(
        numbers<Quad>("patch.window", "four numbers", "[column, row, width, height], whole, from 0 in the north-west",
                      "cells", "part of the source that is pasted; left out: all of it",
                      in_patch<MaybeQuad>([](PatchRecipe& p) -> MaybeQuad& { return p.window; }), [](Quad const& q) {
                          return std::all_of(q.begin(), q.end(),
                                             [](double x) { return x >= 0.0 && x <= 1e6 && x == std::floor(x); }) &&
                                 q[2] >= 1.0 && q[3] >= 1.0;
                      }));
    keys.push_back(file("patch.mask",
                        "polygons, or a raster on the grid: what is pasted; \"\": all that the source covers",
                        in_patch<std::string>([](PatchRecipe& p) -> std::string& { return p.mask; })));
    keys.push_back(number("patch.rotate", "degrees", {-360, 360}, "rotation about its centre, counterclockwise",
                          in_patch<double>([](PatchRecipe& p) -> double& { return p.rotate_deg; })));
    keys.push_back(number("patch.scale", "", {0, 1000, true}, "scale in plan",
                          in_patch<double>([](PatchRecipe& p) -> double& { return p.scale; })));
    keys.push_back(number("patch.gain", "", {-1000, 1000}, "scale of its heights",
                          in_patch<double>([](PatchRecipe& p) -> double& { return p.gain; })));
    keys.push_back(number("patch.feather", "cells", {0, 1e5},
                          "width of the blend from its slopes to those of the terrain, inside its edge",
                          in_patch<double>([](PatchRecipe& p) -> double& { return p.feather_cells; })));
    keys.push_back(choice<PatchRivers>("patch.rivers", {{"keep", PatchRivers::keep}, {"replace", PatchRivers::replace}},
                                       "whether rivers under it keep their heights",
                                       in_patch<PatchRivers>([](PatchRecipe& p) -> PatchRivers& { return p.rivers; })));
}

} // namespace thalweg::pipeline
