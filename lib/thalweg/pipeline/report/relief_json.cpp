// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/relief.hpp>

#include <thalweg/core/numbers/elementary.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <span>

namespace thalweg::pipeline {

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

} // namespace thalweg::pipeline
