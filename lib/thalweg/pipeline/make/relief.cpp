// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/relief.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/pipeline/make/terrain.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg::pipeline {

TerrainRelief relief_of_dem(Raster<float> const& dem, Run const& run) {
    Grid grid = dem.grid();
    grid.cell_m = io::ground_cell(grid).side_m;
    Raster<float> on_ground(grid);
    std::copy(dem.values().begin(), dem.values().end(), on_ground.values().begin());
    return {measure::relief(on_ground, flow::route(on_ground, run), measure::statistics(on_ground, run), {}, run),
            std::nullopt};
}

TerrainRelief relief_of_terrain(Plan const& plan, Terrain const& terrain, measure::Statistics const& statistics,
                                Run const& run) {
    Raster<float> const& dem = terrain.surface->dem;
    TerrainRelief found{measure::relief(dem, *terrain.drainage, statistics, {}, run), std::nullopt};
    double const asked = plan.recipe.surface ? plan.recipe.surface->equilibrium.mean_slope_deg.value_or(0.0) : 0.0;
    double const mean_slope = (asked > 0.0 ? asked : found.land.slopes.mean_deg) * (portable::pi / 180.0);
    if (plan.recipe.network && !std::isnan(mean_slope)) {
        std::vector<std::int64_t> cells =
            terrain.channels.cell; // side valleys that the land has grown climb its slopes
        if (!terrain.equilibrium) {
            for (std::int64_t i = 0; i < terrain.valley.z.cells(); ++i) {
                if (!std::isnan(terrain.valley.z[i])) {
                    cells.push_back(i);
                }
            }
        }
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
    return rows;
}

std::string unlike_land(std::vector<ReliefRow> const& rows, bool rivers_of_file) {
    constexpr std::array<std::string_view, 8> of_texture = {"gradient_anisotropy",      "gradient_correlation_360",
                                                            "gradient_correlation_720", "straight_run",
                                                            "slope_area_ratio",         "level_patch",
                                                            "valleys_over_ridges",      "form_distance"};
    std::vector<std::string> words;
    for (ReliefRow const& row : rows) {
        bool const told = std::find(of_texture.begin(), of_texture.end(), row.key) != of_texture.end() &&
                          !(rivers_of_file && row.key == "straight_run");
        if (told && !row.ok()) {
            words.push_back(
                fmt::format("{} {:.3g} ({:.3g} to {:.3g})", row.key, *row.value, row.range->low, row.range->high));
        }
    }
    return fmt::format("{}", fmt::join(words, ", "));
}

} // namespace thalweg::pipeline
