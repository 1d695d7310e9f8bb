// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/frame/projection.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/read_polygons.hpp>
#include <thalweg/network/growth/tokunaga/embed_tree.hpp>
#include <thalweg/network/growth/tokunaga/grow_strokes.hpp>
#include <thalweg/pipeline/make/internal/plan_rivers.hpp>
#include <thalweg/pipeline/plan/frame.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// The land a network fills, and where it leaves it.
struct Region {
    std::vector<Vec2> ring;
    Vec2 mouth;
};

/// The grid but for a margin of 2 %, so that no river runs along its edge.
Region within(Grid const& grid, Side mouth) {
    double const margin = 0.02 * std::min(grid.east() - grid.west, grid.north - grid.south());
    double const west = grid.west + margin;
    double const east = grid.east() - margin;
    double const south = grid.south() + margin;
    double const north = grid.north - margin;
    Vec2 const middle{0.5 * (west + east), 0.5 * (south + north)};
    Region region{{{west, south}, {east, south}, {east, north}, {west, north}}, middle};
    switch (mouth) {
    case Side::north: region.mouth.y = north; break;
    case Side::east: region.mouth.x = east; break;
    case Side::south: region.mouth.y = south; break;
    case Side::west: region.mouth.x = west; break;
    }
    return region;
}

/// A polygon of a file; the river leaves it where it reaches farthest to the side.
Region inside(Polygons const& polygons, Side mouth) {
    if (polygons.polygons.size() != 1 || polygons.polygons.front().rings.size() != 1) {
        std::size_t rings = 0;
        for (Polygon const& polygon : polygons.polygons) {
            rings += polygon.rings.size();
        }
        throw BadInput(
            fmt::format("network.tokunaga.region = \"{}\" holds {} polygons of {} rings; a network fills one "
                        "without holes",
                        polygons.name, polygons.polygons.size(), rings));
    }
    Region region{polygons.polygons.front().rings.front(), {}};
    if (region.ring.size() > 1 && region.ring.front() == region.ring.back()) {
        region.ring.pop_back();
    }
    auto const reach = [mouth](Vec2 p) {
        switch (mouth) {
        case Side::north: return p.y;
        case Side::east: return p.x;
        case Side::south: return -p.y;
        case Side::west: break;
        }
        return -p.x;
    };
    region.mouth =
        *std::max_element(region.ring.begin(), region.ring.end(), [&](Vec2 a, Vec2 b) { return reach(a) < reach(b); });
    return region;
}

std::vector<std::int64_t> downstream(network::TokunagaTree const& tree) {
    std::vector<std::int64_t> down;
    down.reserve(tree.links.size());
    for (network::TreeLink const& link : tree.links) {
        down.push_back(link.down);
    }
    return down;
}

constexpr char const* more_room = "lower network.tokunaga.order or spacing, or take a larger grid (or smaller cells)";

/// Throws before a network is laid out that has no chance: links would lie at less than half the distance they keep.
void require_room(std::int64_t links, Grid const& grid, double spacing_cells) {
    double const apart = std::sqrt(static_cast<double>(grid.cells()) / static_cast<double>(links));
    double const kept = std::max(spacing_cells, 1.0);
    if (links > 1 && apart < 0.5 * kept) {
        throw BadInput(fmt::format("[network.tokunaga]: {} links on {} x {} cells lie {:.2g} cells apart, and keep {} "
                                   "cells from one another: {}",
                                   links, grid.width, grid.height, apart, kept, more_room));
    }
}

/// Throws where less than half of a network found room; warns where much of it did not.
void judge_room(std::int64_t placed, std::int64_t dropped, Grid const& grid, Run const& run) {
    std::int64_t const all = placed + dropped;
    std::string const found = fmt::format("{} of {} links found no room on {} x {} cells: {}", dropped, all, grid.width,
                                          grid.height, more_room);
    if (2 * placed < all || placed == 0) {
        throw BadInput("[network.tokunaga]: " + found);
    }
    if (10 * placed < 9 * all) {
        run.say("warning: [network.tokunaga]: " + found);
    }
}

Planned fill_region(Recipe recipe, Diary& diary, Run const& run) {
    TokunagaRecipe const& wanted = recipe.network->tokunaga;
    recipe.grid.crs = io::projected_crs(recipe.grid.crs.empty() ? "EPSG:32631" : recipe.grid.crs);
    network::TokunagaTree const tree =
        diary.stage("grow", [&] { return network::grow_tokunaga(tree_of(recipe), run); });
    TokunagaStory story;
    story.tree = network::count_streams(downstream(tree));
    diary.say(fmt::format("lambda {}  order {}  {} links", wanted.generator, wanted.order, tree.links.size()));

    std::optional<Polygons> polygons;
    if (!wanted.region.empty()) {
        polygons = io::read_polygons(file_in(recipe, wanted.region), recipe.grid.crs, run);
    }
    Grid const grid = polygons ? frame_polygons(*polygons, recipe.grid)
                               : frame_tree(static_cast<std::int64_t>(tree.links.size()), recipe.grid);
    require_room(static_cast<std::int64_t>(tree.links.size()), grid, wanted.spacing_cells);
    Region const region = polygons ? inside(*polygons, wanted.mouth) : within(grid, wanted.mouth);
    network::EmbedParams params;
    params.seed = recipe.seed;
    params.region = region.ring;
    params.mouth = region.mouth;
    params.min_spacing_m = wanted.spacing_cells * grid.cell_m;
    network::EmbeddedTree embedded = diary.stage("embed", [&] { return network::embed_tree(tree, params, run); });
    story.placed = embedded.placed;
    story.dropped = embedded.dropped;
    diary.say(
        fmt::format("{} of {} links placed, {:.0f} m apart", embedded.placed, tree.links.size(), embedded.spacing_m));
    judge_room(embedded.placed, embedded.dropped, grid, run);
    return {.recipe = std::move(recipe),
            .plan = std::move(embedded.network),
            .grid = grid,
            .story = {.tokunaga = std::move(story)}};
}

Planned follow_strokes(Recipe recipe, Diary& diary, Run const& run) {
    TokunagaRecipe const& wanted = recipe.network->tokunaga;
    std::string const crs = recipe.grid.crs.empty() ? "" : io::projected_crs(recipe.grid.crs);
    RiverLines const strokes = diary.stage("read", [&] {
        return io::read_rivers({.path = file_in(recipe, wanted.strokes), .layer = wanted.layer, .crs = crs}, run);
    });
    if (!strokes.findings.empty()) { // who draws strokes means each of them
        Finding const& none = strokes.findings.front();
        throw BadInput(
            fmt::format("pipeline.plan_tokunaga: stroke {} of {} at ({:.3f}, {:.3f}) is a single point or has no "
                        "geometry; remove it",
                        none.feature, strokes.name, none.where.x, none.where.y));
    }
    recipe.grid.crs = strokes.crs;
    diary.say(fmt::format("{} strokes from {}", strokes.lines.size(), strokes.name));
    Grid const grid = frame_lines(strokes, recipe.grid);
    network::StrokesParams params;
    params.tree = tree_of(recipe);
    params.max_depth = std::max(wanted.order - 1, 1); // each refinement raises the order by one
    params.min_spacing_m = wanted.spacing_cells * grid.cell_m;
    network::GrownStrokes grown =
        diary.stage("grow", [&] { return network::grow_strokes(strokes, grid, params, run); });
    TokunagaStory story;
    story.placed = grown.placed;
    story.dropped = grown.dropped;
    diary.say(fmt::format("{} of {} links placed", grown.placed, grown.placed + grown.dropped));
    judge_room(grown.placed, grown.dropped, grid, run);
    return {.recipe = std::move(recipe),
            .plan = std::move(grown.network),
            .grid = grid,
            .story = {.tokunaga = std::move(story)}};
}

} // namespace

network::TokunagaParams tree_of(Recipe const& recipe) {
    TokunagaRecipe const& wanted = recipe.network->tokunaga;
    network::TokunagaParams params;
    params.seed = recipe.seed;
    params.generator = wanted.generator;
    params.order = wanted.order;
    params.rule = wanted.rule;
    return params;
}

Planned plan_tokunaga(Recipe recipe, Diary& diary, Run const& run) {
    bool const fills = recipe.network->tokunaga.strokes.empty();
    return fills ? fill_region(std::move(recipe), diary, run) : follow_strokes(std::move(recipe), diary, run);
}

} // namespace thalweg::pipeline
