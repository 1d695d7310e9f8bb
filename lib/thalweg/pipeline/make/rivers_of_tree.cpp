// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/growth/tokunaga/embed_tree.hpp>
#include <thalweg/network/growth/tokunaga/grow_strokes.hpp>
#include <thalweg/pipeline/make/internal/rivers.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>

#include <fmt/format.h>

#include <algorithm>
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

RiversInPlan fill_region(Plan const& plan, Diary& diary, Run const& run) {
    TokunagaRecipe const& wanted = plan.recipe.network->tokunaga;
    network::TokunagaTree const& tree = *plan.tree;
    Grid const& grid = *plan.grid;
    TokunagaStory story;
    story.tree = network::count_streams(downstream(tree));
    Region const region = plan.region ? inside(*plan.region, wanted.mouth) : within(grid, wanted.mouth);
    network::EmbedParams params;
    params.seed = plan.recipe.seed;
    params.region = region.ring;
    params.mouth = region.mouth;
    params.min_spacing_m = wanted.spacing_cells * grid.cell_m;
    network::EmbeddedTree embedded = diary.stage("embed", [&] { return network::embed_tree(tree, params, run); });
    story.placed = embedded.placed;
    story.dropped = embedded.dropped;
    diary.say(
        fmt::format("{} of {} links placed, {:.0f} m apart", embedded.placed, tree.links.size(), embedded.spacing_m));
    judge_room(embedded.placed, embedded.dropped, grid, run);
    return {.network = std::move(embedded.network), .grid = grid, .story = {.tokunaga = std::move(story)}};
}

RiversInPlan follow_strokes(Plan const& plan, Diary& diary, Run const& run) {
    TokunagaRecipe const& wanted = plan.recipe.network->tokunaga;
    Grid const& grid = *plan.grid;
    network::StrokesParams params;
    params.tree = tree_of(plan.recipe);
    params.max_depth = std::max(wanted.order - 1, 1); // each refinement raises the order by one
    params.min_spacing_m = wanted.spacing_cells * grid.cell_m;
    network::GrownStrokes grown =
        diary.stage("grow", [&] { return network::grow_strokes(plan.lines, grid, params, run); });
    TokunagaStory story;
    story.placed = grown.placed;
    story.dropped = grown.dropped;
    diary.say(fmt::format("{} of {} links placed", grown.placed, grown.placed + grown.dropped));
    judge_room(grown.placed, grown.dropped, grid, run);
    return {.network = std::move(grown.network), .grid = grid, .story = {.tokunaga = std::move(story)}};
}

} // namespace

RiversInPlan rivers_of_tree(Plan const& plan, Diary& diary, Run const& run) {
    return plan.tree ? fill_region(plan, diary, run) : follow_strokes(plan, diary, run);
}

} // namespace thalweg::pipeline
