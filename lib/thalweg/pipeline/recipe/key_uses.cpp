// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/key_use.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_asks.hpp>

#include <utility>
#include <vector>

namespace thalweg::pipeline {

namespace {

// What the stages read, and when. A stage that reads a key in another case changes the row here.

Use source_is(char const* word) {
    return is("network.source", {word});
}

Use method_is(std::vector<std::string> const& words) {
    return with("network") && is("surface.method", words);
}

Use equilibrium() {
    return method_is({"equilibrium"});
}

Use dilate() {
    return method_is({"dilate"});
}

/// Terrain that is interpolated between points, in a file or random.
Use from_points() {
    return without("network") && (without("statistics") || is("statistics.skeleton", {"points"}));
}

Use interpolated(std::vector<std::string> const& words) {
    return from_points() && is("surface.method", words);
}

Use tin_of_points() {
    return from_points() && (without("surface") || is("surface.method", {"tin"}));
}

Use diffuse() {
    return is("surface.method", {"diffuse"}) && (with("network") || from_points());
}

Use explicit_diffusion() {
    return diffuse() && is("surface.diffusion", {"explicit"});
}

/// Around rivers only these methods honour ridges and points.
Use skeleton_beside_rivers() {
    return method_is({"diffuse", "tin"}) || (dilate() && is("surface.base", {"tin"}));
}

Use ridges() {
    return skeleton_beside_rivers() && is("skeleton.ridges", {"voronoi", "segments"});
}

Use noise_on_ridges() {
    return method_is({"diffuse"}) && is("skeleton.ridges", {"voronoi", "segments"});
}

Use surface() {
    return without("network") || with("surface");
}

Use extremes() {
    return given("statistics.max") || given("statistics.min");
}

/// Whether rivers have these heights, or may have them once their file is read.
bool may_be(Recipe const& r, Heights heights) {
    if (!r.network) {
        return false;
    }
    if (r.network->heights != Heights::automatic) {
        return r.network->heights == heights;
    }
    return heights == (in_equilibrium(r) ? Heights::graded : Heights::straight_repaired) ||
           (heights == Heights::file && r.network->source == Source::lines);
}

Use slope() {
    return when("network.heights other than \"rosgen\", and other than \"graded\" with surface.method = "
                "\"equilibrium\", whose rivers are graded with the terrain",
                [](Recipe const& r) {
                    bool const by_terrain = in_equilibrium(r);
                    bool found = by_terrain ? false : may_be(r, Heights::graded);
                    for (Heights const h : {Heights::straight, Heights::straight_repaired, Heights::along_stream,
                                            Heights::file, Heights::soft, Heights::fixed, Heights::ends}) {
                        found = found || may_be(r, h);
                    }
                    return found;
                });
}

Use graded() {
    return when("network.heights = \"graded\"", [](Recipe const& r) { return may_be(r, Heights::graded); });
}

using Row = std::pair<std::string, Use>;

std::vector<Row> make_rows() {
    Use const rosgen = is("network.heights", {"rosgen"});
    Use const strokes = source_is("tokunaga") && given("network.tokunaga.strokes");
    Use const no_strokes = source_is("tokunaga") && not_given("network.tokunaga.strokes");
    Use const shape = source_is("forest") && not_given("network.forest.region");
    Use const no_scatter =
        when("skeleton.scatter = 0", [](Recipe const& r) { return !r.skeleton || r.skeleton->scatter == 0; });
    Use const scatters_beside = skeleton_beside_rivers() && above("skeleton.scatter", 0.0);
    Use const scatter = (from_points() || skeleton_beside_rivers()) && above("skeleton.scatter", 0.0);
    Use const midpoint = is("detail.method", {"midpoint"});
    Use const stencils = when("detail.stencil = 4, 12 or 16", [](Recipe const& r) {
        return r.detail && r.detail->midpoint.stencil != fractal::Stencil::exact;
    });
    Use const prior = is("statistics.skeleton", {"separable", "markov3"});
    Use const relief_left_out =
        when("surface.relief = 0", [](Recipe const& r) { return r.surface && r.surface->dilate.relief_m <= 0.0; });
    return {
        {"grid.clip", source_is("lines") || (source_is("forest") && given("network.forest.region"))},

        {"network.slope", slope()},
        {"network.concavity", graded() || equilibrium()},
        {"network.rotate", source_is("dla")},
        {"network.inland", equilibrium() && is("network.source", {"dla", "tokunaga", "lines"})},
        {"network.fill_space", equilibrium()},
        {"network.support", equilibrium() && is("network.fill_space", {"true"})},
        {"network.rosgen", rosgen || above("network.coast", 0.0)},
        {"network.rosgen_slope", rosgen},
        {"network.dla.rule", source_is("dla") && above("network.dla.visits", 1.0) &&
                                 when("network.dla.sticking < 1",
                                      [](Recipe const& r) { return r.network && r.network->dla.sticking < 1.0; })},
        {"network.dla.", source_is("dla")},
        {"network.tokunaga.rule", no_strokes},
        {"network.tokunaga.mouth", no_strokes},
        {"network.tokunaga.layer", strokes},
        {"network.tokunaga.", source_is("tokunaga")},
        {"network.forest.shape", shape},
        {"network.forest.ruggedness", shape && is("network.forest.shape", {"island"})},
        {"network.forest.", source_is("forest")},
        {"network.lines.rank_field", source_is("lines") && (is("network.lines.orientation", {"auto", "rank"}) ||
                                                            (is("network.lines.orientation", {"height", "as_drawn"}) &&
                                                             is("network.lines.divergences", {"main"})))},
        {"network.lines.coastlines", source_is("lines") && is("network.lines.filter", {"natural"})},
        {"network.lines.", source_is("lines")},
        {"network.", always()},

        {"skeleton.ridges", skeleton_beside_rivers()},
        {"skeleton.ridge_gain", ridges() || scatters_beside},
        {"skeleton.ridge_farthest", (ridges() || scatters_beside) && above("skeleton.ridge_gain", 0.0)},
        {"skeleton.ridge_noise", noise_on_ridges()},
        {"skeleton.ridge_wavelength", noise_on_ridges() && above("skeleton.ridge_noise", 0.0)},
        {"skeleton.midpoint_inverse", method_is({"diffuse"})},
        {"skeleton.points", (from_points() || skeleton_beside_rivers()) && no_scatter},
        {"skeleton.scatter", (from_points() || skeleton_beside_rivers()) && not_given("skeleton.points")},
        {"skeleton.spacing", scatter},
        {"skeleton.law", scatter},
        {"skeleton.deviation", from_points() && above("skeleton.scatter", 0.0)},
        {"skeleton.falloff",
         from_points() && above("skeleton.scatter", 0.0) && above("statistics.reach", 0.0) && extremes()},
        {"skeleton.tin", (with("network") && with("surface")) || tin_of_points()},

        {"surface.method", with("network") || from_points()},
        {"surface.base", dilate()},
        {"surface.increment", dilate()},
        {"surface.metric", dilate()},
        {"surface.allow_negative", dilate()},
        {"surface.relief", method_is({"equilibrium", "dilate"})},
        {"surface.mask", with("network") || (from_points() && without("statistics"))},
        {"surface.mean_slope", equilibrium() && relief_left_out},
        {"surface.hillslope", equilibrium()},
        {"surface.floor_width", equilibrium()},
        {"surface.roughness", equilibrium()},
        {"surface.edge", equilibrium()},
        {"surface.uplift", equilibrium()},
        {"surface.erodibility", equilibrium()},
        {"surface.lakes", equilibrium()},
        {"surface.lake_share", equilibrium()},
        {"surface.drain", always()},
        {"surface.diffusion", diffuse()},
        {"surface.tolerance",
         (dilate() && is("surface.base", {"harmonic"})) || (diffuse() && is("surface.diffusion", {"steady"}))},
        {"surface.sweeps", explicit_diffusion()},
        {"surface.start", explicit_diffusion()},
        {"surface.alpha", explicit_diffusion()},
        {"surface.smoothing", diffuse()},
        {"surface.noise", diffuse()},
        {"surface.interpolation", interpolated({"tin"})},
        {"surface.frequency_x", interpolated({"regress"})},
        {"surface.frequency_y", interpolated({"regress"})},
        {"surface.slope_mode", interpolated({"regress"})},
        {"surface.eighth_term", interpolated({"regress"})},

        {"statistics.reach", without("network") && (prior || above("skeleton.scatter", 0.0)) && extremes()},
        {"statistics.falloff", without("network") && prior && extremes()},
        {"statistics.", without("network")},

        {"detail.method", surface()},
        {"detail.adaptation", midpoint && stencils && without("network")},
        {"detail.noise", surface() && midpoint && stencils},
        {"detail.", surface() && midpoint},

        {"patch.rivers", with("network") && with("surface")},
        {"patch.", surface()},

        {"output.contour_interval", surface()},
        {"output.accumulation", surface()},
        {"output.catchments", with("network") && with("surface")},
        {"output.schema", with("network")},
        {"output.", always()},
    };
}

} // namespace

Use use_of(std::string const& path) {
    static std::vector<Row> const rows = make_rows();
    for (auto const& [begin, use] : rows) {
        if (path == begin || (begin.back() == '.' && path.compare(0, begin.size(), begin) == 0)) {
            return use;
        }
    }
    return always();
}

} // namespace thalweg::pipeline
