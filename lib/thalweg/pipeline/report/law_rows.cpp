// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/laws.hpp>

#include <cmath>

namespace thalweg::pipeline {

namespace {

using Details = std::vector<std::pair<std::string_view, double>>;

LawRow row(std::string_view key, std::string_view name, std::string_view unit, std::optional<double> value,
           Details details) {
    if (value && !std::isfinite(*value)) {
        value.reset();
    }
    return {key, name, unit, value, std::move(details), measure::natural_range(key)};
}

LawRow horton_row(std::string_view key, std::string_view name, std::optional<measure::HortonRatio> const& law) {
    return row(key, name, "", law ? std::optional(law->ratio) : std::nullopt,
               law ? Details{{"r2", law->r2}, {"orders", static_cast<double>(law->orders)}} : Details{});
}

LawRow power_row(std::string_view key, std::string_view name, std::optional<measure::PowerLaw> const& law,
                 double sign) {
    return row(key, name, "", law ? std::optional(sign * law->exponent) : std::nullopt,
               law ? Details{{"r2", law->r2},
                             {"error", law->exponent_error},
                             {"bins", static_cast<double>(law->bins.size())},
                             {"arcs", static_cast<double>(law->places)},
                             {"left_out", static_cast<double>(law->left_out)},
                             {"coefficient", law->coefficient}}
                   : Details{});
}

LawRow length_row(std::string_view key, std::string_view name, measure::LengthSpread const& spread) {
    return row(key, name, "m", spread.mean_m,
               {{"links", static_cast<double>(spread.links)}, {"median_m", spread.median_m}, {"cv", spread.cv}});
}

} // namespace

std::vector<LawRow> law_rows(measure::NetworkLaws const& laws) {
    auto const& tokunaga = laws.tokunaga;
    Details const terms =
        tokunaga ? Details{{"r2", tokunaga->r2}, {"terms", static_cast<double>(tokunaga->terms)}} : Details{};
    measure::JunctionAngles const& angles = laws.junctions;
    return {
        horton_row("bifurcation", "bifurcation ratio R_B", laws.horton.bifurcation),
        horton_row("length", "length ratio R_L", laws.horton.length),
        horton_row("area", "area ratio R_A", laws.horton.area),
        row("tokunaga_a", "Tokunaga’s a", "", tokunaga ? std::optional(tokunaga->a) : std::nullopt, terms),
        row("tokunaga_c", "Tokunaga’s c", "", tokunaga ? std::optional(tokunaga->c) : std::nullopt, terms),
        power_row("hack", "Hack’s exponent h", laws.hack, 1.0),
        power_row("concavity", "concavity θ", laws.concavity, -1.0),
        row("drainage_density", "drainage density", "km/km²", laws.drainage_density_m * 1000.0, {}),
        row("junction_angle", "junction angle, mean", "°", angles.mean_deg,
            {{"std_deg", angles.std_deg},
             {"junctions", static_cast<double>(angles.junctions)},
             {"left_out", static_cast<double>(angles.left_out)},
             {"reach_m", angles.reach_m}}),
        length_row("exterior_link", "exterior links, mean length", laws.links.exterior),
        length_row("interior_link", "interior links, mean length", laws.links.interior),
        row("link_ratio", "exterior over interior links", "", laws.links.ratio, {}),
    };
}

} // namespace thalweg::pipeline
