// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/internal/lakes.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/blend/mask_polygons.hpp>
#include <thalweg/core/append.hpp>
#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/recipe/recipe_files.hpp>

namespace thalweg::make {

namespace {

constexpr float no_level = std::numeric_limits<float>::quiet_NaN();

/// One note for all lakes of a file that cover no cell, or a warning where levels are lost.
std::vector<Finding> unseen_lakes(Polygons const& polygons, Raster<std::int32_t> const& labels) {
    std::vector<std::uint8_t> seen(polygons.polygons.size() + 1);
    for (std::int32_t const label : labels.values()) {
        seen[static_cast<std::size_t>(label)] = 1;
    }
    auto const first = std::find(seen.begin() + 1, seen.end(), 0);
    if (first == seen.end()) {
        return {};
    }
    auto const count = std::count(first, seen.end(), 0);
    Polygon const& one = polygons.polygons[static_cast<std::size_t>(first - seen.begin() - 1)];
    std::string text =
        fmt::format("{} of the {} lakes of {} lie off the grid, between the centres of its cells or under others",
                    count, polygons.polygons.size(), polygons.name);
    std::vector<std::string> lost;
    for (std::size_t i = 0; i < polygons.polygons.size(); ++i) {
        Polygon const& lake = polygons.polygons[i];
        if (seen[i + 1] == 0 && !std::isnan(lake.value)) {
            lost.push_back(fmt::format("feature {} with {:.6g} m", lake.feature, lake.value));
        }
    }
    if (!lost.empty()) {
        text += fmt::format("; {} of them have levels, the first is {}", lost.size(), lost.front());
    }
    return {{.kind = lost.empty() ? FindingKind("lake_left_out") : "lakes_unseen",
             .feature = one.feature,
             .where = one.rings.front().front(),
             .amount = static_cast<double>(count),
             .text = std::move(text),
             .key = "surface.lakes"}};
}

/// By cell: number of its lake; 0: none; without cells: no lakes are requested.
struct Lakes {
    Raster<std::int32_t> labels;
    std::vector<Finding> notes = {};
    std::vector<double> level = {}; ///< [m] by number from 1; NaN: it follows from the terrain; empty: all do

    double level_of(std::int64_t number) const {
        return level.empty() ? std::nan("") : level[static_cast<std::size_t>(number - 1)];
    }
};

/// The lakes of a file.
Polygons lake_polygons(recipe::Recipe const& recipe, Grid const& grid, Run const& run) {
    constexpr double most_m = 1e5;
    std::string const& path = recipe.surface->equilibrium.lakes;
    Polygons polygons = io::read_polygons_valued(recipe::file_in(recipe, path), grid.crs, "level", run);
    for (Polygon const& lake : polygons.polygons) {
        refuse_if<BadInput>(std::fabs(lake.value) > most_m, "make.make_terrain",
                            "surface.lakes = \"{}\": feature {} has the level {} m, which is not from {} to {} m", path,
                            lake.feature, lake.value, -most_m, most_m);
    }
    return polygons;
}

/// Takes the cells off lakes that lie in the sea or beside it: their water would leave there instead of at the outlet.
void keep_from_sea(Lakes& lakes, Mask const& land) {
    if (land.cells() == 0) {
        return;
    }
    Grid const& grid = land.grid();
    std::map<std::int32_t, std::pair<std::int64_t, Vec2>> cut; // by label: cells, the first of them
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (lakes.labels[i] <= 0) {
            continue;
        }
        bool is_by_the_sea = false;
        cells_around(grid, grid.at(i), 1, [&](Cell near) { is_by_the_sea |= land[near] == 0; });
        if (is_by_the_sea) {
            auto const [at, is_new] = cut.try_emplace(lakes.labels[i], 0, grid.centre(grid.at(i)));
            ++at->second.first;
            lakes.labels[i] = 0;
        }
    }
    for (auto const& [label, cells] : cut) {
        lakes.notes.push_back({.kind = "lake_cut",
                               .feature = label,
                               .where = cells.second,
                               .amount = static_cast<double>(cells.first),
                               .text = fmt::format("lake {} at ({:.3f}, {:.3f}): cells taken off it beside the sea: {}",
                                                   label, cells.second.x, cells.second.y, cells.first)});
    }
}

Lakes wanted_lakes(recipe::Recipe const& recipe, Planform const& planform, network::ChannelsOfArcs const& rivers,
                   Run const& run) {
    recipe::EquilibriumRecipe const& wanted = recipe.surface->equilibrium;
    if (wanted.lake_share > 0.0) {
        flow::ContributingAreas const areas = flow::areas_nearest(planform.network, planform.grid, run);
        return {
            network::choose_lakes(rivers, areas.ds_area_m2, {.share = wanted.lake_share, .seed = recipe.seed}, run)};
    }
    if (wanted.lakes.empty()) {
        return {};
    }
    Polygons const polygons = lake_polygons(recipe, planform.grid, run);
    Lakes lakes{blend::number_polygons(polygons, planform.grid)};
    lakes.notes = unseen_lakes(polygons, lakes.labels);
    std::ranges::transform(polygons.polygons, std::back_inserter(lakes.level), &Polygon::value);
    return lakes;
}

/// Gives lakes their levels, and their notes; warns of lakes with levels that are left out.
void set_levels(Lakes const& wanted, network::FloodedLakes& flooded) {
    Channels& channels = flooded.drawn.channels;
    for (network::Lake const& lake : flooded.lakes) {
        if (double const level = wanted.level_of(lake.label); !std::isnan(level)) {
            channels.lake_z.resize(channels.cell.size(), no_level);
            channels.lake_z[lake.outlet] = static_cast<float>(level);
        }
    }
    std::vector<Finding> lost;
    for (Finding& note : flooded.notes) {
        double const level = wanted.level_of(note.feature);
        if (std::isnan(level)) {
            continue;
        }
        note.text += fmt::format("; level asked for: {:.6g} m", level);
        if (note.kind == FindingKind("lake_left_out")) {
            lost.push_back(note);
        }
    }
    append(flooded.notes, network::lakes_off_levels(lost));
}

} // namespace

WithLakes with_lakes(recipe::Recipe const& recipe, Planform const& planform, network::ChannelsOfArcs rivers,
                     Run const& run) {
    Lakes lakes = wanted_lakes(recipe, planform, rivers, run);
    if (lakes.labels.cells() == 0) {
        return {std::move(rivers)};
    }
    keep_from_sea(lakes, planform.land);
    network::FloodedLakes flooded = network::flood_lakes(rivers, lakes.labels, run);
    set_levels(lakes, flooded);
    append(lakes.notes, flooded.notes);
    bool const by_levels = !flooded.drawn.channels.lake_z.empty();
    return {std::move(flooded.drawn), std::move(flooded.lakes), std::move(lakes.notes), by_levels};
}

} // namespace thalweg::make
