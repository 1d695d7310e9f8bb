// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/recipe_of_dem.hpp>

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::recipe {

namespace {

/// A text that may stand in a line of TOML: a file's name holds any bytes.
std::string in_one_line(std::string const& text) {
    using nlohmann::json;
    std::string line = json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    return line;
}

void put(DemRecipe& made, std::string const& path, Value const& value) {
    try {
        find_key(path)->put(made.recipe, value);
    } catch (BadParameter const& fault) {
        made.notes.push_back(fmt::format("{} is left out: {}", path, fault.what()));
    }
}

void put_grid(DemRecipe& made, Grid const& grid) {
    io::GroundCell const cell = io::ground_cell(grid);
    put(made, "grid.width", grid.width);
    put(made, "grid.height", grid.height);
    put(made, "grid.cell", cell.side_m);
    switch (cell.unit) {
    case io::GridUnit::metres:
        put(made, "grid.crs", cell.crs);
        if (made.recipe.grid.crs == cell.crs) { // a place means nothing in another system
            put(made, "grid.origin", Pair{grid.west, grid.north});
        }
        break;
    case io::GridUnit::distorted:
        made.notes.push_back(
            fmt::format("Its metres are {:.3g} m on the ground: cells here are squares of {:.2f} m, as "
                        "large as in its middle, at the default origin.",
                        cell.side_m / grid.cell_m, cell.side_m));
        break;
    case io::GridUnit::degrees:
        made.notes.push_back(fmt::format("Its coordinates are geographic: cells here are squares of {:.2f} m, as large "
                                         "as in its middle row, at the default origin.",
                                         cell.side_m));
        break;
    case io::GridUnit::other:
        made.notes.emplace_back(
            "Its coordinates are not in metres: cells here have its size in metres, at the default origin.");
        break;
    case io::GridUnit::unknown:
        made.notes.emplace_back("It has no coordinate system: its units are treated as metres, at the default origin.");
        break;
    }
}

void put_statistics(DemRecipe& made, measure::Statistics const& s) {
    auto const put_known = [&](char const* path, double figure) {
        if (std::isnan(figure)) {
            made.notes.push_back(fmt::format("{} is left out: the heights do not determine it", path));
        } else {
            put(made, path, figure);
        }
    };
    auto const place = [](measure::Extreme const& e) {
        return Triple{e.z, static_cast<double>(e.cell.col), static_cast<double>(e.cell.row)};
    };
    // Of two heights alone the deviation is the bound itself, and rounding may carry it beyond.
    double const most = std::sqrt((s.max.z - s.mean) * (s.mean - s.min.z));
    put(made, "statistics.mean", s.mean);
    put(made, "statistics.std", std::min(s.std, most));
    put(made, "statistics.max", place(s.max));
    put(made, "statistics.min", place(s.min));
    std::vector<std::pair<char const*, solver::CorrelationLength>> const lengths = {{"rows", s.lx}, {"columns", s.ly}};
    bool told = true;
    for (auto const& [axis, length] : lengths) {
        if (std::isnan(length.cells)) {
            told = false;
            made.notes.push_back(
                fmt::format("statistics.length is left out: the heights do not determine it along {}", axis));
        }
    }
    if (told) {
        put(made, "statistics.length", Pair{s.lx.cells, s.ly.cells});
        for (auto const& [axis, length] : lengths) {
            if (length.extrapolated) {
                made.notes.push_back(fmt::format(
                    "The length along {} is extrapolated: heights half the extent apart are still correlated.", axis));
            }
        }
    }
    put_known("statistics.slope", s.slope_rad);
    put_known("statistics.dimension", s.dimension);
}

} // namespace

DemRecipe recipe_of_dem(Raster<float> const& dem, measure::Statistics const& statistics, std::string const& source) {
    refuse_if<BadInput>(!(statistics.min.z < statistics.max.z), "recipe.recipe_of_dem",
                        "every height of {} is {} m: a flat DEM has no statistics to match", source, statistics.max.z);
    DemRecipe made;
    made.notes.push_back(
        in_one_line(fmt::format("Terrain with the statistics of {}, measured on {} cells.", source, statistics.cells)));
    put(made, "output.title", in_one_line(std::filesystem::path(source).stem().string()));
    put_grid(made, dem.grid());
    if (statistics.nodata > 0) {
        made.notes.push_back(
            fmt::format("{} of its cells have no data: the statistics leave them out, and the terrain covers them.",
                        statistics.nodata));
    }
    put_statistics(made, statistics);
    return made;
}

} // namespace thalweg::recipe
