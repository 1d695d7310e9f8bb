// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>

namespace thalweg::pipeline {

Use source_is(char const* word) {
    return is("network.source", {word});
}

Use method_is(std::vector<std::string> const& words) {
    return with("network") && is("surface.method", words);
}

Use by_equilibrium() {
    return method_is({"equilibrium"});
}

Use by_dilation() {
    return method_is({"dilate"});
}

Use by_diffusion() {
    return is("surface.method", {"diffuse"}) && (with("network") || from_points());
}

Use beside_rivers() {
    return method_is({"diffuse", "tin"}) || (by_dilation() && is("surface.base", {"tin"}));
}

Use from_points() {
    return without("network") && (without("statistics") || is("statistics.skeleton", {"points"}));
}

Use has_surface() {
    return without("network") || with("surface");
}

Use has_extremes() {
    return given("statistics.max") || given("statistics.min");
}

} // namespace thalweg::pipeline
