// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/report.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/bounded_json.hpp>
#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/flow/condition.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/make/file_values.hpp>
#include <thalweg/make/laws.hpp>

namespace thalweg::report {
namespace {

using nlohmann::ordered_json;

// Inflows of the grid as a JSON array, the largest first.
std::string inflows_json(Grid const& grid, std::vector<surface::RegionInflow> inflows) {
    std::sort(inflows.begin(), inflows.end(), [](auto const& a, auto const& b) {
        return std::pair{-a.area_cells, a.cell} < std::pair{-b.area_cells, b.cell};
    });
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    for (surface::RegionInflow const& in : inflows) {
        Vec2 const at = grid.centre(grid.at(in.cell));
        array.push_back({{"x", at.x},
                         {"y", at.y},
                         {"area_km2", static_cast<double>(in.area_cells) * grid.cell_m * grid.cell_m * 1e-6}});
    }
    return array.dump();
}

ordered_json extreme(measure::Extreme const& e) {
    return {{"z", e.z}, {"col", e.cell.col}, {"row", e.cell.row}};
}

/// An undefined metric is NaN, which JSON writes as null.
ordered_json dem(measure::Statistics const& s) {
    return {{"cells", s.cells},
            {"nodata", s.nodata},
            {"mean", s.mean},
            {"std", s.std},
            {"min", extreme(s.min)},
            {"max", extreme(s.max)},
            {"slope_rad", s.slope_rad},
            {"slope_true_deg", s.slope_true_deg},
            {"skew", s.skew},
            {"kurtosis", s.kurtosis},
            {"roughness_m", s.roughness_m},
            {"lx_cells", s.lx.cells},
            {"lx_extrapolated", s.lx.extrapolated},
            {"ly_cells", s.ly.cells},
            {"ly_extrapolated", s.ly.extrapolated},
            {"dimension", s.dimension},
            {"dimension_dyadic", s.dimension_dyadic}};
}

ordered_json checks_array(std::vector<Check> const& checks) {
    ordered_json out = ordered_json::array();
    for (Check const& c : checks) {
        out.push_back(
            {{"name", c.name}, {"value", c.value}, {"limit", c.limit}, {"bound", word_of(c.bound)}, {"ok", c.ok}});
    }
    return out;
}

ordered_json finding_object(Finding const& f) {
    FindingRow const& row = f.kind.row();
    ordered_json one{{"kind", row.kind}, {"severity", name_of(row.severity)}, {"feature", f.feature}};
    if (is_finite(f.where)) {
        one["x"] = f.where.x;
        one["y"] = f.where.y;
    }
    if (std::isfinite(f.amount)) {
        one["amount"] = f.amount;
    }
    one["unit"] = row.unit;
    one["text"] = without_passwords(f.text);
    for (auto const& [name, words] :
         {std::pair{"remedy", remedy_of(f)}, {"key", f.key}, {"layer", without_passwords(f.layer)}}) {
        if (!words.empty()) {
            one[name] = words;
        }
    }
    for (FindingNumber const& number : f.numbers) {
        one["numbers"][number.name] = {{"value", number.value}, {"unit", number.unit}};
    }
    return one;
}

ordered_json findings_array(std::vector<Finding> const& findings) {
    ordered_json out = ordered_json::array();
    std::ranges::transform(findings, std::back_inserter(out), finding_object);
    return out;
}

ordered_json recipe_object(recipe::Recipe const& recipe) {
    std::ostringstream text;
    toml::table const table = toml::parse(recipe::write_recipe(recipe));
    text << toml::json_formatter{table};
    return ordered_json::parse(text.str());
}

/// A ratio, or null if it is unknown.
ordered_json ratio(std::optional<measure::HortonRatio> const& law) {
    return law ? ordered_json(law->ratio) : ordered_json(nullptr);
}

ordered_json horton(measure::HortonLaws const& laws) {
    ordered_json orders = ordered_json::array();
    for (measure::StreamOrder const& o : laws.orders) {
        orders.push_back(
            {{"order", o.order}, {"streams", o.streams}, {"length_m", o.length_m}, {"area_m2", o.area_m2}});
    }
    return {{"orders", orders},
            {"bifurcation", ratio(laws.bifurcation)},
            {"length", ratio(laws.length)},
            {"area", ratio(laws.area)}};
}

ordered_json streams_object(network::StreamCounts const& counts) {
    return {{"links", counts.links}, {"streams", counts.streams}, {"side_branches", counts.side}};
}

/// Tokunaga's numbers of side branches: of the network as drawn, and of the tree it was grown from.
ordered_json tokunaga_object(make::MakeResult const& t) {
    ordered_json out{{"drawn", streams_object(t.terrain.rivers.streams)}};
    if (t.planform.statistics.tokunaga &&
        !t.recipe.network->tokunaga.strokes.empty()) { // each has a tree and lambda of its own
        out["grown"] = {{"links", t.planform.statistics.tokunaga->placed + t.planform.statistics.tokunaga->dropped}};
    } else if (t.planform.statistics.tokunaga) {
        growth::TokunagaLaws const laws = growth::tokunaga_laws(t.recipe.network->tokunaga.generator);
        out["grown"] = streams_object(t.planform.statistics.tokunaga->tree);
        out["asked"] = {{"a", laws.a}, {"c", laws.c}, {"bifurcation", laws.bifurcation}};
    }
    if (t.planform.statistics.tokunaga) {
        out["placed"] = t.planform.statistics.tokunaga->placed;
        out["dropped"] = t.planform.statistics.tokunaga->dropped;
    }
    return out;
}

ordered_json laws_object(measure::NetworkLaws const& laws) {
    ordered_json out = ordered_json::object();
    for (make::LawRow const& row : make::law_rows(laws)) {
        ordered_json& law = out[row.key];
        law = {{"value", row.value ? ordered_json(*row.value) : ordered_json(nullptr)}, {"unit", row.unit}};
        for (auto const& [name, figure] : row.details) {
            law[name] = figure;
        }
        if (row.nature != nullptr) {
            law["range"] = {row.nature->low, row.nature->high};
            law["source"] = row.nature->source;
        }
    }
    return out;
}

ordered_json dem_laws_object(make::DemLaws const& found) {
    ordered_json out = laws_object(found.laws);
    out["support"] = {
        {"cells", found.support_cells}, {"area_m2", found.support_m2}, {"as_dense_as_the_network", found.as_dense}};
    out["edge"] = {{"arcs", found.arcs}, {"arcs_inside", found.arcs_inside}};
    out["inside"] = found.inside ? laws_object(*found.inside) : ordered_json(nullptr);
    return out;
}

ordered_json network_object(make::MakeResult const& t) {
    StreamNetwork const& plan = t.terrain.rivers.network.planform;
    double const length = std::accumulate(plan.length_m().begin(), plan.length_m().end(), 0.0);
    int strahler = 0;
    for (int const s : t.terrain.rivers.orders.strahler) {
        strahler = std::max(strahler, s);
    }
    auto const arcs = static_cast<std::int64_t>(plan.arc_count());
    network::HeightReport const& h = t.terrain.bed.heights.repair;
    return {{"arcs", arcs},
            {"nodes", plan.node_count()},
            {"outlets", plan.outlets().size()},
            {"strahler", strahler},
            {"length_m", length},
            {"traced", t.planform.statistics.arcs_traced},
            {"pruned", t.planform.statistics.arcs_traced - t.planform.statistics.arcs_kept},
            {"particles", t.planform.statistics.particles},
            {"walkers", t.planform.statistics.walkers},
            {"stopped_at", t.planform.statistics.particles == 0 ? ""
                           : t.planform.statistics.full         ? "full"
                           : t.planform.statistics.cut          ? "margin"
                           : t.planform.statistics.wide         ? "radius"
                                                                : "particles"},
            {"uphill_before_repair",
             {{"arcs", h.uphill_arcs}, {"length_m", h.uphill_length_m}, {"max_rise_m", h.max_rise_m}}},
            {"lifted", {{"count", h.lifted}, {"max_m", h.max_lift_m}, {"rms_m", h.rms_lift_m}}},
            {"lowered_cells",
             {{"count", t.terrain.bed.heights.lowered_cells}, {"max_m", t.terrain.bed.heights.max_lowered_m}}},
            {"area_from", t.terrain.water.areas.source},
            {"horton", horton(t.assessment.laws.network ? t.assessment.laws.network->horton : measure::HortonLaws{})},
            {"tokunaga", tokunaga_object(t)},
            {"laws", t.assessment.laws.network ? laws_object(*t.assessment.laws.network) : ordered_json(nullptr)}};
}

ordered_json agreements_object(measure::Agreements const& agreements) {
    ordered_json out = ordered_json::array();
    for (std::size_t k = 0; k < agreements.size(); ++k) {
        measure::Agreement const& a = agreements[k];
        out.push_back({{"within_cells", k}, {"precision", a.precision}, {"recall", a.recall}, {"f", a.f()}});
    }
    return out;
}

ordered_json certificate_object(measure::Certificate const& c) {
    double const cells = static_cast<double>(std::max<std::int64_t>(c.river_cells, 1));
    return {{"depressions",
             {{"count", c.depressions},
              {"cells", c.pit_cells},
              {"max_depth_m", c.max_depth_m},
              {"volume_m3", c.pit_volume_m3}}},
            {"river_cells", c.river_cells},
            {"following_share", static_cast<double>(c.following_cells) / cells},
            {"border_cells", c.border_cells},
            {"lake_cells", c.lake_cells},
            {"waived_cells", c.waived_cells},
            {"sources", c.sources},
            {"sources_arriving", c.arriving_sources},
            {"traced", agreements_object(c.traced)},
            {"extracted", {{"area_cells", c.threshold_cells}, {"agreement", agreements_object(c.extracted)}}},
            {"areas",
             {{"compared", c.compared_areas},
              {"within_5_percent", c.close_areas},
              {"max_difference", c.max_area_difference}}}};
}

ordered_json change_object(flow::DemChange const& c) {
    return {{"raised_cells", c.raised_cells}, {"cut_cells", c.cut_cells}, {"max_raise_m", c.max_raise_m},
            {"max_cut_m", c.max_cut_m},       {"raised_m3", c.raised_m3}, {"cut_m3", c.cut_m3}};
}

ordered_json statistics_object(fractal::MatchedDem const& p) {
    ordered_json residuals = ordered_json::array();
    for (fractal::Residual const& r : p.residuals) {
        residuals.push_back({{"name", r.name}, {"asked", r.asked}, {"got", r.got}, {"error", r.error}});
    }
    return {{"converged", p.converged},
            {"iterations", p.iterations},
            {"limited_cells", p.limited_cells},
            {"residuals", residuals}};
}

/// Factor from the recipe's increments to those used.
double metres_per_unit(make::MakeResult const& t) {
    std::vector<double> const& used = t.terrain.ground.dilated().increments;
    std::vector<double> const named =
        surface::increments(static_cast<std::int64_t>(used.size()), t.recipe.surface->dilate.increment);
    auto const greatest =
        std::max_element(named.begin(), named.end(), [](double a, double b) { return std::fabs(a) < std::fabs(b); });
    return greatest == named.end() || *greatest == 0.0
               ? 1.0
               : used[static_cast<std::size_t>(greatest - named.begin())] / *greatest;
}

/// Times of stages, by their names.
ordered_json by_stage(Timings const& timings, double StageTime::*quantity) {
    ordered_json out = ordered_json::object();
    for (StageTime const& time : timings) {
        out[time.stage] = time.*quantity;
    }
    return out;
}

ordered_json given_object(make::GivenLength const& given) {
    ordered_json left_out;
    for (std::size_t i = 0; i < given.left_out_m.size(); ++i) {
        left_out[make::key_of(static_cast<LeftOut>(i))] = given.left_out_m[i];
    }
    return {{"read_m", given.read_m},       {"left_out_m", left_out},           {"given_m", given.given_m()},
            {"kept_m", given.kept_m},       {"connector_m", given.connector_m}, {"turned_m", given.turned_m},
            {"moved_max_m", given.moved_m}, {"closed_m", given.closed_m},       {"carried_m", given.carried_m}};
}

/// Rivers by the heights that they miss.
ordered_json rivers_off(make::GivenHeights const& heights) {
    ordered_json out = ordered_json::array();
    for (make::RiverOff const& river : heights.rivers) {
        out.push_back({{"feature", river.feature},
                       {"vertices", river.vertices},
                       {"median_off_m", river.median_off_m},
                       {"p99_off_m", river.p99_off_m},
                       {"most_off_m", river.most_off_m}});
    }
    return out;
}

void add_rivers(make::MakeResult const& t, ordered_json& report) {
    if (t.recipe.network) {
        report["network"] = network_object(t);
        report["network"]["secondary"] = t.assessment.given ? t.assessment.given->secondary.size() : 0;
        if (t.assessment.given) {
            report["given"] = given_object(*t.assessment.given);
        }
        if (t.assessment.given_heights) {
            make::GivenHeights const& heights = *t.assessment.given_heights;
            report["given"]["heights"] = {{"tolerance_m", heights.tolerance_m}, {"vertices", heights.vertices},
                                          {"missed", heights.missed},           {"mean_m", heights.mean_m},
                                          {"largest_m", heights.largest_m},     {"median_off_m", heights.median_off_m},
                                          {"p99_off_m", heights.p99_off_m},     {"most_off_m", heights.most_off_m},
                                          {"rivers", rivers_off(heights)}};
        }
        if (t.assessment.given_areas) {
            make::GivenAreas const& areas = *t.assessment.given_areas;
            report["given"]["areas"] = {{"arcs", areas.arcs},
                                        {"median", areas.median},
                                        {"p05", areas.low},
                                        {"p95", areas.high},
                                        {"within_factor_2", areas.within_factor_2}};
        }
        report["shortened_fields"] = ordered_json::array();
        for (io::ShortenedName const& one : make::shortened_names(t)) {
            report["shortened_fields"].push_back({{"field", one.name}, {"in_shapefile", one.in_shapefile}});
        }
    }
}

void add_dem(make::MakeResult const& t, ordered_json& report) {
    if (t.assessment.statistics) {
        report["dem"] = dem(*t.assessment.statistics);
        report["dem"]["hypsometric_integral"] = t.assessment.hypsometry->integral;
        if (!t.terrain.ground.dilated().increments.empty()) {
            report["dem"]["flat_share"] = t.terrain.ground.dilated().flat_share;
            report["dem"]["levels"] = t.terrain.ground.dilated().levels;
            report["dem"]["metres_per_unit"] = metres_per_unit(t);
        }
        report["dem"]["pit_cells"] = t.assessment.pits;
        report["dem"]["pit_volume_m3"] = t.assessment.pit_volume_m3;
        if (t.assessment.laws.dem) {
            report["dem"]["laws"] = dem_laws_object(*t.assessment.laws.dem);
        }
        if (t.assessment.relief) {
            report["dem"]["relief"] = ordered_json::parse(make::relief_json(*t.assessment.relief));
        }
    }
}

void add_drainage(make::MakeResult const& t, ordered_json& report) {
    if (t.terrain.water.is_conditioned) {
        report["drained"] = {{"banks", change_object(t.terrain.water.banks)},
                             {"depressions", change_object(t.terrain.water.depressions)}};
    }
    if (t.assessment.certificate) {
        report["certificate"] = certificate_object(*t.assessment.certificate);
    }
    if (t.assessment.catchments) {
        auto const& cells = t.assessment.catchments->cells;
        report["catchments"] = {{"count", std::count_if(cells.begin(), cells.end(), [](auto n) { return n > 0; })},
                                {"cells_without", t.assessment.catchments->without}};
    }
}

ordered_json against_object(make::Against const& against) {
    ordered_json terrains;
    for (make::TerrainAgainst const& terrain : against.terrains) {
        terrains[terrain.key] = ordered_json::parse(figures_against(terrain));
    }
    return {{"dem", against.dem},
            {"cells", against.cells},
            {"mean_slope_deg", against.real.mean_slope_deg},
            {"hypsometric_integral", against.real.hypsometric_integral},
            {"terrains", terrains}};
}

ordered_json features_object(make::GivenFeatures const& given) {
    constexpr std::size_t listed = 1000;
    ordered_json out;
    if (!given.points.empty()) {
        ordered_json points = ordered_json::array();
        for (std::size_t i = 0; i < std::min(listed, given.points.size()); ++i) {
            make::PointOff const& p = given.points[i];
            points.push_back({{"point", p.number},
                              {"x", p.at.x},
                              {"y", p.at.y},
                              {"asked_m", p.asked_m},
                              {"z_m", p.z_m},
                              {"in_river", p.in_river}});
        }
        out["points"] = {{"count", given.points.size()},
                         {"tolerance_m", given.tolerance_m},
                         {"missed", given.missed()},
                         {"each", points}};
    }
    if (!given.ridges.empty()) {
        ordered_json ridges = ordered_json::array();
        for (std::size_t i = 0; i < std::min(listed, given.ridges.size()); ++i) {
            make::RidgeOff const& r = given.ridges[i];
            ridges.push_back(
                {{"feature", r.feature}, {"cells", r.cells}, {"at_rivers", r.in_rivers}, {"crossed", r.crossed}});
            if (r.most_m) {
                ridges.back()["most_m"] = *r.most_m;
            }
        }
        out["ridge_lines"] = {{"count", given.ridges.size()}, {"each", ridges}};
    }
    return out;
}

void add_lines(make::MakeResult const& t, ordered_json& report) {
    if (t.assessment.given_features) {
        report["features"] = features_object(*t.assessment.given_features);
    }
    if (!t.terrain.ground.tin.vertices.empty()) {
        report["tin"] = {{"vertices", t.terrain.ground.tin.vertices.size()},
                         {"triangles", t.terrain.ground.tin.triangles.size()}};
    }
    if (!t.terrain.ground.ridges.lines.empty()) {
        report["ridges"] = {{"count", t.terrain.ground.ridges.lines.size()}};
        if (t.assessment.surface_ridges) {
            report["ridges"]["cells"] = t.assessment.surface_ridges->ridge_cells;
            report["ridges"]["extracted"] = {{"area_cells", t.assessment.surface_ridges->threshold_cells},
                                             {"agreement", agreements_object(t.assessment.surface_ridges->extracted)}};
        }
    }
}

/// Adds the statistics of the terrain's construction.
void add_statistics(make::MakeResult const& t, ordered_json& report) {
    make::Ground const& ground = t.terrain.ground;
    if (make::Equilibrium const* const found = ground.equilibrium()) {
        make::Equilibrium const& e = *found;
        report["equilibrium"] = {
            {"channel_cells", e.channel_cells},
            {"lakes", t.terrain.bed.lakes},
            {"shortened_cells", e.shortened_cells},
            {"graded_heads", e.graded_heads},
            {"walled_cells", e.walled_cells},
            {"lowered", {{"max_m", e.max_lowered_m}, {"p95_m", e.p95_lowered_m}}},
            {"rise", e.rise},
            {"steepness", std::isnan(e.steepness) ? ordered_json(nullptr) : ordered_json(e.steepness)},
            {"heights_invented", make::heights_are_invented(t.recipe)},
            {"side_valleys", t.terrain.bed.grown},
            {"side_valleys_left_out", t.terrain.bed.left_out},
            {"in_region", e.in_region},
            {"inflows", ordered_json::parse(inflows_json(t.terrain.grid, e.inflows))}};
        if (!t.recipe.layers.empty()) {
            report["equilibrium"]["strata_shift_m"] = e.strata_shift_m;
            report["equilibrium"]["strata_strike_deg"] = make::strata_of(t.recipe, t.terrain.grid).strike_deg;
            report["equilibrium"]["layer_shares"] = t.assessment.layer_shares;
        }
        if (e.like) {
            report["equilibrium"]["like"] = {{"mean_slope_deg", e.like->mean_slope_deg},
                                             {"lag_m", e.like->lag_m},
                                             {"wanted_correlation", e.like->wanted_correlation},
                                             {"correlation", e.like->correlation},
                                             {"roughness", e.like->roughness}};
        }
        if (auto const* const rebuilt = std::get_if<make::Rebuilt>(&ground.how)) {
            report["equilibrium"]["rebuilt"] = {{"source_km2", rebuilt->source_km2},
                                                {"river_spacing_m", rebuilt->river_spacing_m},
                                                {"river_concavity", rebuilt->river_concavity},
                                                {"smooth_slope_deg", rebuilt->smooth_slope_deg}};
        }
    }
    if (auto const* const diffused = std::get_if<make::ByDiffusion>(&ground.how)) {
        report["diffusion"] = {{"iterations", diffused->iterations}, {"residual", diffused->residual}};
    }
    for (make::PatchStatistics const& p : t.terrain.ground.patches) {
        report["patches"].push_back(
            {{"cells", p.cells}, {"kept", p.kept}, {"seam_max_m", p.seam_max_m}, {"seam_rms_m", p.seam_rms_m}});
    }
    if (t.terrain.ground.matched) {
        report["statistics"] = statistics_object(t.terrain.ground.matched->projection);
        report["statistics"]["fine_forms_cells"] = t.terrain.ground.matched->fine_forms_cells;
    }
}

} // namespace

bool is_repair(Finding const& finding) {
    FindingRow const& row = finding.kind.row();
    return row.severity == Severity::note && row.printed == Printed::verbose;
}

std::string version() {
    return THALWEG_VERSION;
}

std::string write_report(make::MakeResult const& t, std::vector<std::string> const& files, Timings const& writing) {
    Timings timings = make::timings_of(t);
    append(timings, writing);
    ordered_json report{{"version", version()},
                        {"recipe", recipe_object(t.recipe)},
                        {"timings_s", by_stage(timings, &StageTime::wall_s)},
                        {"cpu_s", by_stage(timings, &StageTime::cpu_s)},
                        {"peak_mb", by_stage(timings, &StageTime::peak_mb)},
                        {"peak_rss_mb", static_cast<double>(peak_memory_bytes()) / 1e6}};
    add_rivers(t, report);
    add_dem(t, report);
    add_drainage(t, report);
    add_lines(t, report);
    add_statistics(t, report);
    if (t.assessment.against) {
        report["against"] = against_object(*t.assessment.against);
    }
    report["checks"] = checks_array(t.assessment.checks);
    std::vector<Finding> const findings = make::findings_of(t);
    std::vector<Finding> no_faults;
    std::ranges::copy_if(findings, std::back_inserter(no_faults),
                         [](Finding const& finding) { return finding.severity() != Severity::error; });
    report["findings"] = findings_array(findings);
    report["repairs"] = findings_array(no_faults); // under their name of earlier versions
    report["files"] = files;
    return report.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string figures_against(make::TerrainAgainst const& terrain) {
    measure::Likeness const& like = terrain.like;
    ordered_json const figures{{"correlation", like.correlation},
                               {"correlation_above_river", like.correlation_above_river},
                               {"rmse_m", like.rmse_m},
                               {"bias_m", like.bias_m},
                               {"same_reach", like.same_reach},
                               {"divides_found", like.divides_found},
                               {"divides_right", like.divides_right},
                               {"slopes_difference", like.slopes_difference},
                               {"mean_slope_deg", terrain.shape.mean_slope_deg},
                               {"hypsometric_integral", terrain.shape.hypsometric_integral}};
    return figures.dump();
}

std::string checks_json(std::vector<Check> const& checks) {
    return checks_array(checks).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::vector<std::string> files_of_report(std::string const& json) {
    std::vector<std::string> files;
    auto const report = bounded_json<nlohmann::json>(json, {.most_keys = std::size_t{1} << 20U});
    if (!report.is_object() || !report.contains("files") || !report["files"].is_array()) {
        return files;
    }
    for (auto const& name : report["files"]) {
        if (name.is_string()) {
            files.push_back(name.get<std::string>());
        }
    }
    return files;
}

std::string statistics_json(measure::Statistics const& statistics, make::DemLaws const* laws,
                            make::TerrainRelief const* relief) {
    ordered_json out = dem(statistics);
    if (laws != nullptr) {
        out["laws"] = dem_laws_object(*laws);
    }
    if (relief != nullptr) {
        out["relief"] = ordered_json::parse(make::relief_json(*relief));
    }
    return out.dump() + "\n";
}

std::string line_laws_json(make::LineLaws const& found) {
    ordered_json const out{{"arcs", found.arcs},
                           {"outlets", found.outlets},
                           {"length_m", found.length_m},
                           {"left_out", {{"lines", found.left_out}, {"length_m", found.left_out_m}}},
                           {"horton", horton(found.laws.horton)},
                           {"tokunaga", streams_object(found.streams)},
                           {"laws", laws_object(found.laws)}};
    return out.dump() + "\n";
}

std::string findings_json(std::vector<Finding> const& findings) {
    return findings_array(findings).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string finding_json(Finding const& finding) {
    return finding_object(finding).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string certificate_json(measure::Certificate const& certificate) {
    return certificate_object(certificate).dump();
}

} // namespace thalweg::report
