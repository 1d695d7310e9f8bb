// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/forecast_words.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace thalweg::tools {

namespace {

std::string time_in_words(double seconds) {
    double const rounded = std::max(1.0, std::ceil(seconds));
    return rounded < 120.0 ? fmt::format("{:.0f} s", rounded) : fmt::format("{:.0f} min", std::ceil(seconds / 60.0));
}

std::string as_json(pipeline::Forecast const& forecast) {
    nlohmann::ordered_json json{{"stages", forecast.stages}, {"grid", nullptr}};
    if (forecast.grid) {
        Grid const& grid = *forecast.grid;
        json["grid"] = {{"width", grid.width}, {"height", grid.height}, {"cell", grid.cell_m},
                        {"west", grid.west},   {"north", grid.north},   {"crs", grid.crs}};
    }
    json["cells"] = forecast.cells;
    json["memory_bytes"] = forecast.memory_bytes;
    json["seconds"] = forecast.seconds;
    return json.dump(2) + "\n";
}

} // namespace

std::string forecast_in_words(pipeline::Forecast const& forecast, bool json) {
    if (json) {
        return as_json(forecast);
    }
    std::string text = fmt::format("stages     {}\n", fmt::join(forecast.stages, ", "));
    if (forecast.grid) {
        Grid const& grid = *forecast.grid;
        text +=
            fmt::format("grid       {} x {} cells of {} m, {}, from ({}, {})\n", grid.width, grid.height, grid.cell_m,
                        grid.crs.empty() || grid.crs.size() > 40 ? "own CRS" : grid.crs, grid.west, grid.north);
    } else {
        text += fmt::format("grid       follows from the grown rivers: about {:.1g} cells\n",
                            static_cast<double>(forecast.cells));
    }
    text += fmt::format("memory     at most {:.2g} GB\n", static_cast<double>(forecast.memory_bytes) / 1e9);
    text += fmt::format("time       about {} on one core\n", time_in_words(forecast.seconds));
    return text + "nothing was written\n";
}

} // namespace thalweg::tools
