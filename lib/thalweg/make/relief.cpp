// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/relief.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/append.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/measure/relief/slopes.hpp>

namespace thalweg::make {

Raster<float> on_ground(Raster<float> const& dem) {
    Grid grid = dem.grid();
    grid.cell_m = io::ground_cell(grid).side_m;
    Raster<float> out(grid);
    std::copy(dem.values().begin(), dem.values().end(), out.values().begin());
    return out;
}

TerrainRelief relief_of_dem(Raster<float> const& dem, flow::FlowField const& drainage, Run const& run) {
    return {measure::relief(dem, drainage, measure::statistics(dem, run), {}, run), std::nullopt};
}

TerrainRelief relief_of_dem(Raster<float> const& dem, Run const& run) {
    Raster<float> const ground = on_ground(dem);
    return relief_of_dem(ground, flow::route(ground, run), run);
}

TerrainRelief relief_of_terrain(recipe::Recipe const& recipe, Terrain const& terrain,
                                measure::Statistics const& statistics, Run const& run) {
    Raster<float> const& dem = terrain.ground.dem;
    std::vector<std::int64_t> cells;
    if (recipe.network) {
        cells = terrain.bed.channels.cell; // side valleys grown by the terrain climb its slopes
        if (!terrain.ground.equilibrium()) {
            append(cells, terrain.bed.valley.cell);
        }
    }
    TerrainRelief found{measure::relief(dem, terrain.water.drainage, statistics, cells, {}, run), std::nullopt};
    double const asked = recipe.surface ? recipe.surface->equilibrium.mean_slope_deg.value_or(0.0) : 0.0;
    double const mean_slope = (asked > 0.0 ? asked : found.land.slopes.mean_deg) * (portable::pi / 180.0);
    if (recipe.network && !std::isnan(mean_slope)) {
        double const rise_m = portable::sin(mean_slope) / portable::cos(mean_slope) * dem.grid().cell_m;
        found.perched = static_cast<std::int64_t>(measure::perched(dem, cells, rise_m).size());
    }
    return found;
}

std::vector<ReliefRow> relief_rows(TerrainRelief const& relief) {
    auto const known = [](double value) { return std::isnan(value) ? std::nullopt : std::optional(value); };
    auto const lands = measure::reference_dems();
    std::vector<ReliefRow> rows;
    auto const& figures = measure::relief_metrics();
    for (std::size_t f = 0; f < figures.size(); ++f) {
        ReliefRow row{figures[f].key, figures[f].name, figures[f].unit, known(figures[f].of(relief.land)), {}, {}};
        for (measure::ReferenceDem const& land : lands) {
            row.beside.push_back(land.figures[f]);
        }
        if (figures[f].judges != measure::Judges::no) {
            row.range = measure::relief_range(f);
        }
        rows.push_back(std::move(row));
    }
    auto const mean = measure::mean_forms();
    ReliefRow forms{"form_distance", "distance of geomorphons from the reference DEMs", "", std::nullopt, {}, {}};
    if (std::any_of(relief.land.forms.begin(), relief.land.forms.end(), [](double share) { return share > 0.0; })) {
        forms.value = measure::total_variation(relief.land.forms, mean);
    }
    for (measure::ReferenceDem const& land : lands) {
        forms.beside.push_back(measure::total_variation(land.forms, mean));
    }
    forms.range = {0.0,
                   measure::ReliefMetric{}.tolerance * *std::max_element(forms.beside.begin(), forms.beside.end())};
    rows.push_back(std::move(forms));
    if (relief.perched) {
        rows.push_back({"perched",
                        "river cells that stand perched",
                        "",
                        static_cast<double>(*relief.perched),
                        {},
                        measure::ReliefRange{0.0, 0.0}});
    }
    if (!std::isnan(relief.land.variety.wall)) {
        rows.push_back({"wall",
                        "drop beside the divide of the given rivers, over the drop elsewhere",
                        "",
                        relief.land.variety.wall,
                        {},
                        measure::ReliefRange{0.0, 1.5}});
    }
    return rows;
}

namespace {

/// What it means when an index is below or above its range, and what changes that.
struct Meaning {
    std::string_view key;
    bool of_texture;
    std::string_view low; ///< "": no fault
    std::string_view low_remedy;
    std::string_view high;
    std::string_view high_remedy;
};

constexpr std::array<Meaning, 11> meanings = {{
    {"gradient_anisotropy", true, "ridges have no direction", "raise surface.grain", "all ridges are parallel",
     "lower surface.grain"},
    {"gradient_correlation_360", true, "hillsides are rougher", "lower surface.roughness", "hillsides are smoother",
     "raise surface.roughness"},
    {"gradient_correlation_720", true, "hillsides are rougher", "lower surface.roughness", "hillsides are smoother",
     "raise surface.roughness"},
    {"straight_run", true, "", "", "a channel runs straight for longer", "raise network.meander, or try another seed"},
    {"slope_area_ratio", true, "rivers are gentler beside their hillsides", "lower network.concavity",
     "rivers are steeper beside their hillsides", "raise network.concavity"},
    {"level_patch", true, "there is less level ground",
     "raise surface.floor_width, or vary uplift: surface.uplift_pattern", "more of the land is one plain",
     "raise surface.mean_slope"},
    {"valleys_over_ridges", true, "there are more ridges than valleys", "lower surface.hillslope",
     "there are more valleys than ridges", "raise surface.hillslope"},
    {"form_distance", true, "", "", "other forms of the land are frequent",
     "docs/relief_measures.md says which are counted"},
    {"canals", false, "", "", "rivers run between steep banks, as in canals",
     "smaller cells (grid.cell) or less mean slope make them fewer"},
    {"steepest_drop", true, "", "", "there are walls: drops over 1 km far above the usual ones",
     "lower surface.relief, surface.mean_slope or surface.uplift_contrast"},
    {"wall", true, "", "", "the land falls as a wall beside the divide of the rivers",
     "give the rivers heights, or lower surface.relief"},
}};

void add_once(std::vector<std::string_view>& words, std::string_view one) {
    if (std::find(words.begin(), words.end(), one) == words.end()) {
        words.push_back(one);
    }
}

} // namespace

UnlikeRealLand unlike_real_land(std::vector<ReliefRow> const& rows, ComparedRelief const& compared) {
    std::vector<std::string_view> faults;
    std::vector<std::string_view> remedies;
    std::vector<std::string> figures;
    for (Meaning const& meaning : meanings) {
        auto const row =
            std::find_if(rows.begin(), rows.end(), [&](ReliefRow const& r) { return r.key == meaning.key; });
        if (row == rows.end() || row->ok() || (meaning.of_texture && !compared.has_texture) ||
            (compared.rivers_of_file && meaning.key == "straight_run")) {
            continue;
        }
        bool const is_low = *row->value < row->range->low;
        add_once(faults, is_low ? meaning.low : meaning.high);
        add_once(remedies, is_low ? meaning.low_remedy : meaning.high_remedy);
        figures.push_back(fmt::format("{} {:.3g}, real land {:.3g} to {:.3g}", row->key, *row->value, row->range->low,
                                      row->range->high));
    }
    if (faults.empty()) {
        return {};
    }
    return {fmt::format("unlike real land, {} ({})", fmt::join(faults, "; "), fmt::join(figures, "; ")),
            fmt::format("To change that: {}", fmt::join(remedies, "; "))};
}

namespace {

using nlohmann::ordered_json;

constexpr std::array<char const*, measure::form_count> form_names = {"flat",  "peak",   "ridge",     "shoulder", "spur",
                                                                     "slope", "hollow", "footslope", "valley",   "pit"};

ordered_json rows_object(TerrainRelief const& relief) {
    auto const lands = measure::reference_dems();
    ordered_json out = ordered_json::object();
    for (ReliefRow const& row : relief_rows(relief)) {
        ordered_json one{{"name", row.name},
                         {"value", row.value ? ordered_json(*row.value) : ordered_json(nullptr)},
                         {"unit", row.unit}};
        for (std::size_t l = 0; l < row.beside.size(); ++l) {
            one["beside"][lands[l].name] = row.beside[l];
        }
        if (row.range) {
            one["range"] = {row.range->low, row.range->high};
            one["in_range"] = row.ok();
        }
        out[row.key] = std::move(one);
    }
    return out;
}

/// Bins as [area in km2, slope, cells].
ordered_json bins_array(std::span<measure::AreaBin const> bins) {
    ordered_json out = ordered_json::array();
    for (measure::AreaBin const& bin : bins) {
        out.push_back({bin.area_m2 / 1e6, bin.value, bin.places});
    }
    return out;
}

ordered_json slope_area_object(std::optional<measure::PowerLaw> const& law) {
    if (!law) {
        return nullptr;
    }
    ordered_json fit = ordered_json::array();
    for (measure::AreaBin const* end : {&law->bins.front(), &law->bins.back()}) {
        fit.push_back({end->area_m2 / 1e6, law->coefficient * portable::pow(end->area_m2, law->exponent)});
    }
    return {{"theta", -law->exponent},
            {"error", law->exponent_error},
            {"r2", law->r2},
            {"bins", bins_array(law->bins)},
            {"fit", fit},
            {"cells", law->places},
            {"left_out", law->left_out}};
}

ordered_json chi_object(std::optional<measure::Chi> const& chi) {
    if (!chi) {
        return nullptr;
    }
    return {{"theta", chi->theta},     {"r2", chi->r2},
            {"main_r2", chi->main_r2}, {"main_steepness", chi->main_steepness},
            {"stems", chi->stems},     {"cells", chi->cells}};
}

ordered_json slopes_object(measure::Slopes const& slopes) {
    ordered_json out{{"cells", slopes.cells},
                     {"mean_deg", slopes.mean_deg},
                     {"std_deg", slopes.std_deg},
                     {"tangent_mean", slopes.tangent_mean},
                     {"tangent_cv", slopes.tangent_cv}};
    for (std::size_t p = 0; p < measure::slope_percents.size(); ++p) {
        out[fmt::format("p{}", measure::slope_percents[p])] = slopes.percentile_deg[p];
    }
    out["shares_of_2_deg"] = slopes.shares;
    return out;
}

ordered_json forms_object(std::array<double, measure::form_count> const& shares) {
    ordered_json out = ordered_json::object();
    for (std::size_t f = 0; f < shares.size(); ++f) {
        out[form_names[f]] = shares[f];
    }
    return out;
}

} // namespace

std::string relief_json(TerrainRelief const& relief) {
    measure::Relief const& land = relief.land;
    ordered_json lands = ordered_json::array();
    for (measure::ReferenceDem const& real : measure::reference_dems()) {
        lands.push_back({{"name", real.name},
                         {"source", real.source},
                         {"cell_m", real.cell_m},
                         {"slopes", real.slopes},
                         {"forms", forms_object(real.forms)},
                         {"slope_area", bins_array(real.slope_area)}});
    }
    ordered_json const out{
        {"figures", rows_object(relief)},
        {"slopes", slopes_object(land.slopes)},
        {"forms", forms_object(land.forms)},
        {"slope_area", slope_area_object(land.slope_area)},
        {"chi", chi_object(land.chi)},
        {"extremes", {{"pits", land.extremes.pits}, {"peaks", land.extremes.peaks}, {"cells", land.extremes.cells}}},
        {"drainage", {{"support_cells", land.support_cells}, {"density_km", 1000.0 * land.drainage_density}}},
        {"beside", lands}};
    return out.dump();
}

} // namespace thalweg::make
