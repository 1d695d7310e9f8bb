// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/live_page.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/gdal/packed.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/recipe_keys.hpp>
#include <thalweg/report/internal/page_template.hpp>
#include <thalweg/report/page.hpp>

namespace thalweg::report {

LivePage live_page(std::string const& title, std::string const& studio) {
    static constexpr std::string_view before = R"(http-equiv="Content-Security-Policy" content=")";
    PageParts parts;
    parts.title = html_text(title);
    parts.studio = without_tags(studio);
    LivePage page;
    page.html = fill_page(page_template(), parts);
    static constexpr std::string_view nobody = "connect-src 'none'";
    page.html.replace(page.html.find(nobody), nobody.size(), "connect-src 'self'");
    std::size_t const begin = page.html.find(before) + before.size();
    page.policy = page.html.substr(begin, page.html.find('"', begin) - begin) + "; frame-ancestors 'none'";
    return page;
}

std::optional<LiveHeights> live_heights(Raster<float> const& dem, Grid const& grid) {
    LiveHeights heights;
    bool const is_finest = dem.width() == grid.width && dem.height() == grid.height;
    std::int64_t const square = is_finest ? page_cells(grid) : 1;
    heights.cells = is_finest ? square : (grid.width + dem.width() - 1) / dem.width();
    heights.values = square > 1 ? mean_of_squares(dem, square) : dem;
    auto const range = height_range(heights.values);
    if (!range) {
        return std::nullopt;
    }
    heights.min = range->first;
    heights.max = range->second;
    heights.nodata = std::ranges::count_if(heights.values.values(), [](float z) { return std::isnan(z); });
    return heights;
}

std::string live_scene(make::MakeResult const& made, std::string const& recipe, std::string const& command,
                       Run const& run) {
    PageParams params = page_params_of(made, recipe);
    params.command = command;
    if (made.terrain.has_surface()) {
        params.summits = summits(made.terrain.ground.dem, summits_named, run);
    }
    PageLines const lines = lines_of_page(made);
    std::optional<PageHeights> const heights =
        made.terrain.has_surface() ? page_values(made.terrain.ground.dem, run) : std::nullopt;
    std::vector<std::uint8_t> const water = heights && made.terrain.has_surface()
                                                ? page_water(made.terrain.water.drainage, params.lakes, *heights)
                                                : std::vector<std::uint8_t>{};
    return fmt::format(R"("data":{},"lines":"{}","water":"{}")", page_data(made, params, heights, lines),
                       io::packed(lines.bytes), water.empty() ? "" : io::packed(water));
}

make::MakeResult planform_preview(recipe::Recipe const& recipe, make::Planform const& planform) {
    make::MakeResult made;
    made.recipe = recipe;
    made.terrain.grid = planform.grid;
    StreamNetwork const& network = planform.network;
    ElevatedNetwork level{network, std::vector<double>(network.node_count(), 0.0), {}};
    for (ArcId a = 0; a < network.arc_count(); ++a) {
        level.arc_z.emplace_back(network.arc(a).line.size(), 0.0);
    }
    made.terrain.rivers = make::rivers_of(std::move(level), planform.types, planform.file.clues);
    made.terrain.water.areas.us_area_m2.assign(network.arc_count(), 0.0);
    made.terrain.water.areas.ds_area_m2.assign(network.arc_count(), 0.0);
    made.terrain.water.areas.node_m2.assign(network.node_count(), 0.0);
    return made;
}

std::optional<ClusterArms> cluster_arms(recipe::Recipe const& recipe, std::int64_t side, Run const& run) {
    if (!recipe::from_cluster(recipe)) {
        return std::nullopt;
    }
    growth::Cluster const cluster = make::cluster_of(recipe, run);
    Cell low = cluster.cells.front();
    Cell high = low;
    for (Cell const c : cluster.cells) {
        low = {std::min(low.col, c.col), std::min(low.row, c.row)};
        high = {std::max(high.col, c.col), std::max(high.row, c.row)};
    }
    std::int64_t const wide = high.col - low.col + 1;
    std::int64_t const tall = high.row - low.row + 1;
    std::int64_t const cells = std::max<std::int64_t>(1, (std::max(wide, tall) + side - 1) / side); // a place
    ClusterArms arms;
    arms.width = (wide + cells - 1) / cells;
    arms.height = (tall + cells - 1) / cells;
    std::vector<std::uint8_t> places(static_cast<std::size_t>(arms.width * arms.height));
    arms.chosen = std::get<std::string>(*recipe::find_key("network.dla.branch")->take(recipe));
    auto const paint = [&](std::vector<Cell> const& branch, std::uint8_t arm) {
        for (Cell const c : branch) {
            auto const place = (c.row - low.row) / cells * arms.width + (c.col - low.col) / cells;
            places[static_cast<std::size_t>(place)] = arm;
        }
    };
    constexpr std::uint8_t no_arm = 5;
    paint(cluster.cells, no_arm);
    std::uint8_t arm = 0;
    for (growth::BranchChoice const choice : {growth::BranchChoice::north, growth::BranchChoice::east,
                                              growth::BranchChoice::south, growth::BranchChoice::west}) {
        ++arm;
        try {
            paint(growth::pick_branch(cluster, {.choice = choice}).cells, arm);
        } catch (BadInput const&) { // it has no such arm
        }
    }
    arms.arms = io::packed(places);
    return arms;
}

} // namespace thalweg::report
