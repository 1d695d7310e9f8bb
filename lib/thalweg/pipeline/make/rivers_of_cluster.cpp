// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/network/growth/dla/grow_dla.hpp>
#include <thalweg/network/growth/dla/pick_branch.hpp>
#include <thalweg/network/planform/rotate.hpp>
#include <thalweg/network/vectorise/thin.hpp>
#include <thalweg/network/vectorise/trace.hpp>
#include <thalweg/pipeline/make/internal/rivers.hpp>
#include <thalweg/pipeline/plan/frame.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// A frame for what will be turned before it is put into the grid that is asked for.
GridRecipe loosely_framed(GridRecipe frame) {
    frame.width = 0;
    frame.height = 0;
    return frame;
}

/// The grid asked for, or one with room for the whole branch as it was picked: when that is asked for, the branch is
/// cut no shorter.
Grid turned_frame(network::Branch const& branch, Grid frame, GridRecipe const& wanted, double turn_deg) {
    frame.width = wanted.width;
    frame.height = wanted.height;
    if (frame.width == 0) {
        double const c = portable::cos(turn_deg / 180.0 * portable::pi);
        double const s = portable::sin(turn_deg / 180.0 * portable::pi);
        Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
        Vec2 high{-low.x, -low.y};
        for (Cell const& cell : branch.cells) {
            auto const x = static_cast<double>(cell.col);
            auto const y = static_cast<double>(cell.row);
            Vec2 const at{c * x + s * y, c * y - s * x};
            low = {std::min(low.x, at.x), std::min(low.y, at.y)};
            high = {std::max(high.x, at.x), std::max(high.y, at.y)};
        }
        auto const wide = static_cast<std::int64_t>(std::ceil(high.x - low.x + 1.0));
        auto const tall = static_cast<std::int64_t>(std::ceil(high.y - low.y + 1.0));
        std::int64_t const margin = margin_around(std::max(wide, tall));
        frame.width = wide + 2 * margin;
        frame.height = tall + 2 * margin;
    }
    check_memory(frame.width, frame.height);
    return frame;
}

/// The arm of a cluster that becomes the rivers.
network::Branch branch_of(network::Cluster const& cluster, Recipe const& recipe) {
    network::BranchParams params{recipe.network->branch, 0, 0, *recipe.network->rotate_deg};
    if (recipe.grid.width > 0) {
        params.max_width = room_for_network(recipe.grid.width);
        params.max_height = room_for_network(recipe.grid.height);
    }
    return network::pick_branch(cluster, params);
}

} // namespace

RiversInPlan rivers_of_cluster(Plan const& plan, Diary& diary, Run const& run) {
    Recipe const& recipe = plan.recipe;
    NetworkRecipe const& wanted = *recipe.network;
    NetworkStory story;
    run.at(0.0, fmt::format("grow {} particles", wanted.dla.particles).c_str());
    network::Cluster const cluster = diary.stage("grow", [&] { return network::grow_dla(wanted.dla, run); });
    story.wide = cluster.stop == network::GrowthStop::radius;
    diary.say(fmt::format("{} particles  seed {}  radius {:.0f} cells{}", cluster.cells.size(), recipe.seed,
                          cluster.radius, story.wide ? ", where it stops" : ""));
    story.particles = static_cast<std::int64_t>(cluster.cells.size());
    story.walkers = cluster.walkers;

    network::Branch const branch = branch_of(cluster, recipe);
    story.cut = branch.cut;
    double const turn_deg = *wanted.rotate_deg;
    FramedBranch const framed = frame_branch(branch, turn_deg == 0.0 ? recipe.grid : loosely_framed(recipe.grid));
    Mask const skeleton = diary.stage("thin", [&] { return network::thin(framed.mask, run); });
    StreamNetwork network = diary.stage("trace", [&] { return network::trace(skeleton, {framed.mouth}, run); });
    Grid grid = framed.mask.grid();
    if (turn_deg != 0.0) {
        network::Rotated turned =
            network::rotate(network, turned_frame(branch, grid, recipe.grid, turn_deg), {turn_deg});
        network = std::move(turned.network);
        grid = turned.grid;
    }
    return {.network = std::move(network), .grid = grid, .story = std::move(story)};
}

} // namespace thalweg::pipeline
