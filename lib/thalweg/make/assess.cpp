// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/small_blocks.hpp>
#include <thalweg/make/file_values.hpp>
#include <thalweg/make/internal/assess.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {

namespace {

/// Counts arcs that rise somewhere. The schema allows level ones: lakes, tidal reaches.
std::int64_t uphill_arcs(ElevatedNetwork const& network) {
    return std::count_if(network.arc_z.begin(), network.arc_z.end(), [](std::vector<double> const& z) {
        return std::adjacent_find(z.begin(), z.end(), std::less<>()) != z.end();
    });
}

std::int64_t valley_cells_moved(ValleyCells const& valley, Raster<float> const& dem) {
    std::int64_t moved = 0;
    for (std::size_t i = 0; i < valley.cell.size(); ++i) {
        moved += valley.z[i] == dem[valley.cell[i]] ? 0 : 1;
    }
    return moved;
}

Check none_of(char const* name, std::int64_t count) {
    return {name, static_cast<double>(count), 0.0, count == 0};
}

/// What the rivers claim of the surface.
measure::Claims claims_of(recipe::Recipe const& recipe, Terrain const& terrain) {
    measure::Claims claims;
    claims.ds_area_m2 = terrain.water.areas.ds_area_m2;
    claims.still = either(still_cells(measure::as_file(terrain.rivers.network, terrain.rivers.orders), terrain.grid),
                          lake_cells(terrain.bed.channels));
    claims.drawn = river_mask(terrain.bed.valley);
    if (replaces_rivers(recipe)) {
        claims.honoured = claims.drawn;
    }
    return claims;
}

/// Checks that a conditioned surface drains, by its rivers where it honours them.
std::vector<Check> drainage_checks(SurfaceMeasures const& found, flow::FlowField const& drainage) {
    return found.certificate
               ? found.certificate->checks()
               : std::vector<Check>{none_of("depressions", static_cast<std::int64_t>(drainage.depressions.size()))};
}

/// Checks of the surface: first of what the recipe asks, then that it kept the rivers' heights and drains.
std::vector<Check> surface_checks(recipe::Recipe const& recipe, Terrain const& terrain, SurfaceMeasures const& found) {
    std::vector<Check> checks = terrain.notes.checks;
    if (terrain.has_surface() && recipe.network) {
        checks.push_back(none_of("valley_cells_moved", valley_cells_moved(terrain.bed.valley, terrain.ground.dem)));
    }
    if (terrain.water.is_conditioned) {
        append(checks, drainage_checks(found, terrain.water.drainage));
    }
    return checks;
}

/// Says what a reader of the hillshade would see: terrain in equilibrium that is not like land.
void warn_of_relief(recipe::Recipe const& recipe, Terrain const& terrain, TerrainRelief const& relief,
                    StageLog& stage_log) {
    constexpr std::int64_t least_cells = 250'000;                  // with fewer, randomness dominates
    if (!terrain.ground.equilibrium() || !recipe.layers.empty()) { // the reference DEMs show no layers
        return;
    }
    UnlikeRealLand const found =
        unlike_real_land(relief_rows(relief), {terrain.grid.cells() >= least_cells, recipe::from_lines(recipe)});
    if (!found.text.empty()) {
        stage_log.find({.kind = "unusual_relief", .text = found.text, .remedy = found.remedy});
    }
}

/// "1, 3 and 4".
std::string list_of(std::vector<std::size_t> const& numbers) {
    std::string out;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        out += fmt::format("{}{}", k == 0 ? "" : k + 1 == numbers.size() ? " and " : ", ", numbers[k]);
    }
    return out;
}

/// Says which layers of rock do not show as the recipe has them.
void warn_of_layers(recipe::Recipe const& recipe, Terrain const& terrain, std::vector<double> const& shares,
                    StageLog& stage_log) {
    surface::Strata const strata = strata_of(recipe, terrain.grid);
    double const upright = 1.0 / portable::cos(strata.dip_deg * portable::pi / 180.0);
    double const dip = portable::sin(strata.dip_deg * portable::pi / 180.0) * upright;
    double const tilt = dip + 2.0 * portable::pi * strata.folds.amplitude_m / strata.folds.wavelength_m;
    double const step_m = terrain.grid.cell_m * tilt;
    std::vector<std::size_t> thin;
    std::vector<std::size_t> unseen;
    double steepest = 0.0;
    for (std::size_t k = 0; k < strata.layers.size(); ++k) {
        bool const has_end = strata.repeats || k + 1 < strata.layers.size();
        if (has_end && strata.layers[k].thickness_m * upright < step_m) {
            thin.push_back(k + 1);
        }
        if (shares[k] == 0.0) {
            unseen.push_back(k + 1);
        } else {
            steepest = std::max(steepest, strata.layers[k].cliff);
        }
    }
    if (!thin.empty()) {
        stage_log.find(
            {.kind = "thin_layers",
             .amount = static_cast<double>(thin.size()),
             .text = fmt::format("layers {} (counted from the lowest) are thinner than {:.3g} m, by which their "
                                 "beds rise over one cell: they show as single cells",
                                 list_of(thin), step_m),
             .key = "layer"});
    }
    if (!unseen.empty()) {
        stage_log.find(
            {.kind = "unseen_layers",
             .amount = static_cast<double>(unseen.size()),
             .text = fmt::format("layers {} (counted from the lowest) lie nowhere at the surface", list_of(unseen)),
             .key = "strata.base"});
    }
    double const slope = recipe.surface->equilibrium.mean_slope_deg.value_or(0.0) * portable::pi / 180.0;
    if (!(recipe.surface->dilate.relief_m > 0.0) && steepest * portable::cos(slope) < portable::sin(slope)) {
        stage_log.find(
            {.kind = "gentle_layers",
             .amount = steepest,
             .text = fmt::format("surface.mean_slope = {:.3g} degrees is steeper than any slope may be in the "
                                 "layers at the surface, whose steepest has cliff = {:.3g}",
                                 *recipe.surface->equilibrium.mean_slope_deg, steepest),
             .key = "layer"});
    }
    if (std::int64_t const cells = terrain.ground.equilibrium()->held_back; cells > 0) {
        stage_log.find({.kind = "held_back_slopes",
                        .amount = static_cast<double>(cells),
                        .text = fmt::format("{} cells are as high as land in layers may be, twice the greatest height "
                                            "without: beds climb there and no river cuts them",
                                            cells),
                        .key = "surface.edge"});
    }
}

/// Measures a surface, with the rivers on it.
SurfaceMeasures of_surface(recipe::Recipe const& recipe, Terrain const& terrain, StageLog& stage_log, Run const& run) {
    flow::FlowField const& drainage = terrain.water.drainage;
    Raster<float> const& dem = terrain.ground.dem;
    StreamNetwork const& network = terrain.rivers.network.planform;
    SurfaceMeasures found;
    found.statistics = stage_log.stage(recipe::stage::measure.name, [&] { return measure::statistics(dem, run); });
    found.hypsometry = measure::hypsometry(dem, run);
    if (has_layers(recipe, terrain.ground)) {
        surface::Strata const strata = strata_of(recipe, terrain.grid);
        found.layers = surface::layers_at(dem, bed_of(recipe, terrain.ground, terrain.grid, run), strata, run);
        found.layer_shares = surface::shares_of_layers(found.layers, strata.layers.size());
        warn_of_layers(recipe, terrain, found.layer_shares, stage_log);
    }
    found.pits = drainage.pits;
    found.pit_volume_m3 = drainage.pit_volume_m3;
    if (recipe.network) {
        if (recipe.network->inland == recipe::InlandEnds::sink) {
            found.sinks = inland_ends(network, dem);
        }
        found.certificate = stage_log.stage(recipe::stage::certify.name, [&] {
            return measure::certify(dem, drainage, flow::reaches_of(network), claims_of(recipe, terrain), run);
        });
    }
    if (recipe::stage::ridges.runs(recipe)) {
        found.surface_ridges = stage_log.stage(recipe::stage::ridges.name, [&] {
            return terrain.ground.ridges.lines.empty()
                       ? std::nullopt
                       : std::optional(measure::extract_ridges(dem, terrain.ground.ridges, run));
        });
    }
    if (found.surface_ridges) {
        measure::Agreement const& within_a_cell = found.surface_ridges->extracted[1];
        stage_log.say(
            fmt::format("{:.0f} % of those asked for are ridges of the surface, {:.0f} % of its own are asked for",
                        100.0 * within_a_cell.recall, 100.0 * within_a_cell.precision));
    }
    if (recipe::stage::areas.runs(recipe)) {
        found.water_areas = stage_log.stage(recipe::stage::areas.name, [&] {
            return WaterAreas{areas_m2(drainage), areas_m2(flow::route_dinf(dem, drainage, run).area_cells)};
        });
    }
    found.laws = stage_log.stage(recipe::stage::laws.name,
                                 [&] { return laws_of_terrain(terrain, found.statistics->cells, run); });
    return_small_blocks(); // of the streams of the DEM
    found.relief = stage_log.stage(recipe::stage::relief.name,
                                   [&] { return relief_of_terrain(recipe, terrain, *found.statistics, run); });
    return_small_blocks();
    warn_of_relief(recipe, terrain, *found.relief, stage_log);
    if (recipe::stage::catchments.runs(recipe)) {
        found.catchments = stage_log.stage(recipe::stage::catchments.name,
                                           [&] { return flow::catchments(flow::reaches_of(network), drainage, run); });
    }
    return found;
}

/// Returns the findings only if the certificate failed.
std::vector<Finding> findings_of(std::optional<measure::Certificate> const& certificate) {
    if (!certificate) {
        return {};
    }
    std::vector<Check> const checks = certificate->checks();
    bool const ok = std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; });
    return ok ? std::vector<Finding>{} : certificate->findings;
}

/// Checks the network's topology: arcs descend and connect.
measure::TopologyReport topology_of(Terrain const& terrain, StageLog& stage_log, Run const& run) {
    return stage_log.stage(recipe::stage::check.name, [&] {
        return measure::check_topology(measure::as_file(terrain.rivers.network, terrain.rivers.orders), {}, run);
    });
}

/// A number > 0 rounded down to one digit.
double one_digit(double number) {
    double power = 1.0;
    for (; power > number; power /= 10.0) {
    }
    for (; power * 10.0 <= number; power *= 10.0) {
    }
    return std::floor(number / power) * power;
}

/// Warns where the cells are so large that many arcs have none of their own: such terrain is a few blocks, whatever its
/// checks say.
void warn_of_coarse_cells(Terrain const& terrain, StageLog& stage_log, Run const& run) {
    constexpr double worth_a_word = 0.2;
    constexpr double cells_an_arc = 8.0;
    StreamNetwork const& network = terrain.rivers.network.planform;
    if (network.arc_count() == 0 || !terrain.has_surface()) {
        return;
    }
    std::vector<bool> has_cell(network.arc_count());
    for (flow::RiverCell const& cell : flow::river_cells(flow::reaches_of(network), terrain.grid, run)) {
        has_cell[cell.reach] = true;
    }
    auto const without = std::ranges::count(has_cell, false);
    double const share = static_cast<double>(without) / static_cast<double>(network.arc_count());
    if (share > worth_a_word) {
        double const length_m = std::accumulate(network.length_m().begin(), network.length_m().end(), 0.0);
        double const fine_m = length_m / static_cast<double>(network.arc_count()) / cells_an_arc;
        stage_log.find(
            {.kind = "crowded_rivers",
             .amount = share,
             .text = fmt::format("{} of the {} arcs have no cell of their own: cells of {:g} m are too large "
                                 "for these {:.1f} km of rivers",
                                 without, network.arc_count(), terrain.grid.cell_m, length_m / 1000.0),
             .remedy = fine_m > 0.0 ? fmt::format("Smaller cells show them: --set grid.cell={:g}",
                                                  one_digit(std::min(fine_m, terrain.grid.cell_m / 2.0)))
                                    : "",
             .key = "grid.cell"});
    }
}

/// The check given_length; notes the account of the input's length, and warns where more than 1 % of it is missing.
Check length_check(recipe::LinesRecipe const& wanted, std::string const& file, GivenLength const& given,
                   Grid const& grid, StageLog& stage_log) {
    constexpr double worth_a_word = 0.99;
    double const share = given.share();
    double const least = wanted.keep;
    stage_log.find({.kind = "given",
                    .amount = given.given_m(),
                    .text = line_of(given),
                    .key = "network.lines.path",
                    .layer = file,
                    .numbers = {{"kept", given.kept_m, "m"}}});
    if (share < worth_a_word) {
        double const gone_m = given.given_m() - given.kept_m;
        double const short_m = given.left_out(LeftOut::too_short);
        stage_log.find(
            {.kind = "rivers_missing",
             .amount = gone_m,
             .text = fmt::format("{:.1f} of the {:.1f} km of rivers in {} are not in the network, {}. Layer secondary "
                                 "of network.gpkg has them",
                                 gone_m / 1000.0, given.given_m() / 1000.0, file,
                                 short_m > 0.5 * gone_m ? "most of them too short"
                                                        : "most of them cut at heads that lie beside other rivers"),
             .remedy = short_m < gone_m
                           ? fmt::format("Finer cells keep them apart: --set grid.cell={}", grid.cell_m / 2.0)
                           : "",
             .key = "network.lines.path",
             .layer = file,
             .numbers = {{"given", given.given_m(), "m"}}});
    }
    return {"given_length", share, least, share >= least, Bound::at_least};
}

void warn_of_heights(std::string const& file, GivenHeights const& given, StageLog& stage_log) {
    stage_log.find({.kind = "heights",
                    .amount = given.largest_m,
                    .text = line_of(given),
                    .key = "network.heights",
                    .layer = file});
    if (given.missed > 0) {
        stage_log.find(
            {.kind = "heights_missed",
             .amount = given.largest_m,
             .text = fmt::format("at {} of the {} vertices with heights in {} dem.tif is off by more than "
                                 "{:g} m: by {:.3g} m on average, by {:.3g} m at most",
                                 given.missed, given.vertices, file, given.tolerance_m, given.mean_m, given.largest_m),
             .key = "network.heights_tolerance",
             .layer = file,
             .numbers = {{"missed", static_cast<double>(given.missed), "vertices"},
                         {"vertices", static_cast<double>(given.vertices), "vertices"},
                         {"mean", given.mean_m, "m"}}});
    }
}

/// Warns of given points and ridges that the terrain does not have, with a finding for each point.
void warn_of_features(GivenFeatures const& given, StageLog& stage_log) {
    constexpr std::size_t listed = 1000;
    constexpr double most_crossed = 0.05; // of a ridge's cells
    constexpr double most_at_rivers = 0.5;
    std::vector<PointOff> missed;
    std::ranges::copy_if(given.points, std::back_inserter(missed),
                         [&](PointOff const& p) { return !(std::fabs(p.z_m - p.asked_m) <= given.tolerance_m); });
    std::ranges::stable_sort(missed, std::greater<>(), [](PointOff const& p) {
        double const off = std::fabs(p.z_m - p.asked_m);
        return std::isnan(off) ? std::numeric_limits<double>::infinity() : off;
    });
    auto const words = [](PointOff const& p) {
        return fmt::format("point {} at ({:.1f}, {:.1f}) asks for {:.6g} m, the {} {}", p.number, p.at.x, p.at.y,
                           p.asked_m, p.in_river ? "river there has" : "terrain has",
                           std::isnan(p.z_m) ? "no height there" : fmt::format("{:.6g} m", p.z_m));
    };
    for (std::size_t i = 0; i < std::min(listed, missed.size()); ++i) {
        stage_log.find(
            {"point_missed", missed[i].number, missed[i].at, missed[i].z_m - missed[i].asked_m, words(missed[i])});
    }
    if (!missed.empty()) {
        stage_log.find({.kind = "points_missed",
                        .feature = missed.front().number,
                        .where = missed.front().at,
                        .amount = static_cast<double>(missed.size()),
                        .text = fmt::format("{} of the {} points of {} are missed by more than {:g} m. The worst: {}",
                                            missed.size(), given.points.size(), given.points_file, given.tolerance_m,
                                            words(missed.front())),
                        .key = "skeleton.points",
                        .layer = given.points_file,
                        .numbers = {{"points", static_cast<double>(given.points.size())}}});
    }
    std::vector<RidgeOff> crossed;
    std::ranges::copy_if(given.ridges, std::back_inserter(crossed), [](RidgeOff const& r) {
        auto const cells = static_cast<double>(r.cells);
        return static_cast<double>(r.crossed) > most_crossed * cells ||
               static_cast<double>(r.in_rivers) > most_at_rivers * cells;
    });
    if (!crossed.empty()) {
        RidgeOff const& first = crossed.front();
        stage_log.find({.kind = "ridges_crossed",
                        .feature = first.feature,
                        .amount = static_cast<double>(crossed.size()),
                        .text = fmt::format("{} of the {} ridges of {} are crossed by water or lie at rivers. The "
                                            "first, feature {}: of {} cells {} lie at rivers, and water crosses {}",
                                            crossed.size(), given.ridges.size(), given.ridges_file, first.feature,
                                            first.cells, first.in_rivers, first.crossed),
                        .key = "skeleton.ridge_lines",
                        .layer = given.ridges_file});
    }
}

} // namespace

bool Assessment::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; });
}

Assessment assess(AssessInput const& in, Run const& run) {
    StageLog stage_log(run);
    recipe::Recipe const& recipe = in.recipe;
    Planform const& planform = in.planform;
    Terrain const& terrain = in.terrain;
    Assessment found{terrain.has_surface()
                         ? of_surface(recipe, terrain, stage_log, run)
                         : SurfaceMeasures{.laws = laws_of_terrain(terrain, terrain.grid.cells(), run)}};
    found.checks = surface_checks(recipe, terrain, found);
    if (recipe.network) {
        measure::TopologyReport topology = topology_of(terrain, stage_log, run);
        found.checks.insert(found.checks.begin(), none_of("uphill_arcs", uphill_arcs(terrain.rivers.network)));
        append(found.checks, std::move(topology.checks));
        stage_log.find(topology.findings);
        if (terrain.water.is_conditioned) {
            stage_log.find(findings_of(found.certificate));
        }
    }
    warn_of_coarse_cells(terrain, stage_log, run);
    if (recipe::from_lines(recipe)) {
        found.given = given_length(in.found_in_lines, planform, terrain);
        found.checks.push_back(
            length_check(recipe.network->lines, in.lines.name, *found.given, terrain.grid, stage_log));
    }
    if (recipe.network) {
        found.given_heights = given_heights(*recipe.network, in.lines, planform, terrain);
    }
    if (found.given_heights) {
        warn_of_heights(in.lines.name, *found.given_heights, stage_log);
    }
    found.given_features = given_features(recipe, in.points, in.ridges, terrain);
    if (found.given_features) {
        stage_log.find({.kind = "features", .text = line_of(*found.given_features)});
        warn_of_features(*found.given_features, stage_log);
    }
    if (terrain.has_surface() && found.given) {
        found.given_areas = given_areas(in.lines, planform, terrain);
    }
    if (found.given_areas) {
        stage_log.find({.kind = "areas", .text = line_of(*found.given_areas)});
    }
    if (recipe::stage::compare.runs(recipe)) {
        found.against = stage_log.stage(recipe::stage::compare.name, [&] {
            return compare_with_dem(in.against, recipe.output.against, terrain, run);
        });
        stage_log.say(line_of(*found.against));
    }
    found.findings = stage_log.take_findings();
    found.timings_s = stage_log.take();
    run.report(found.findings);
    return found;
}

} // namespace thalweg::make
