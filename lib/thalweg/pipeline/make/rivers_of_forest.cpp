// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/growth/forest/plant_forest.hpp>
#include <thalweg/pipeline/make/internal/rivers.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace thalweg::pipeline {

RiversInPlan rivers_of_forest(Plan const& plan, Diary& diary, Run const& run) {
    Recipe const& recipe = plan.recipe;
    ForestRecipe const& wanted = recipe.network->forest;
    ForestLand const& on = *plan.forest;
    network::ForestParams params = wanted.growth;
    params.step_cells = wanted.spacing_cells / 2;
    params.seed = recipe.seed;
    network::PlantedForest planted =
        diary.stage("grow", [&] { return network::plant_forest(on.land, on.outlets, params, run); });
    diary.say(fmt::format("{} trees of {} particles  seed {}", planted.outlets, planted.particles, recipe.seed));
    NetworkStory story;
    story.repairs = on.notes;
    story.repairs.insert(story.repairs.end(), planted.notes.begin(), planted.notes.end());
    story.particles = planted.particles;
    story.walkers = planted.walkers;
    story.full = planted.stop == network::ForestStop::full;
    return {.network = std::move(planted.network),
            .grid = on.land.grid(),
            .land = on.has_sea ? on.land : Mask{},
            .story = std::move(story)};
}

std::vector<Finding> pruned_outlets(StreamNetwork const& before, StreamNetwork const& after) {
    auto const places = [](StreamNetwork const& network) {
        std::vector<Vec2> at;
        for (NodeId const n : network.outlets()) {
            at.push_back(network.node(n).at);
        }
        std::ranges::sort(at, [](Vec2 a, Vec2 b) { return a.y != b.y ? a.y > b.y : a.x < b.x; });
        return at;
    };
    std::vector<Vec2> const left = places(after);
    std::vector<Finding> notes;
    for (Vec2 const p : places(before)) {
        if (std::ranges::find(left, p) == left.end()) {
            notes.push_back({"pruned_outlet", 0, p, 0.0,
                             fmt::format("the river that ended at ({:.1f}, {:.1f}) was pruned away, its branches are "
                                         "all too short",
                                         p.x, p.y)});
        }
    }
    return notes;
}

} // namespace thalweg::pipeline
