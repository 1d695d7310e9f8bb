// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/pipeline/make/rivers.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/plan/plan.hpp>

/// Where rivers run. Private to this module.
namespace thalweg::pipeline {

/// A network in plan on its grid, with the file's heights where lines carry them.
struct RiversInPlan {
    StreamNetwork network;
    Grid grid;
    std::optional<ElevatedNetwork> file_heights = {};
    Mask land = {}; ///< 0: sea; without cells: all is land
    RiverFile file = {};
    NetworkStory story = {};
};

/// One arm of a cluster that grew by diffusion-limited aggregation, thinned and traced.
RiversInPlan rivers_of_cluster(Plan const& plan, Diary& diary, Run const& run);

/// Networks that branch by Tokunaga's law: one that fills the grid or a region, or one along each stroke of a file.
RiversInPlan rivers_of_tree(Plan const& plan, Diary& diary, Run const& run);

/// Trees that grow from a coast or border inland until the land is full of them. Every outlet lies there.
RiversInPlan rivers_of_forest(Plan const& plan, Diary& diary, Run const& run);

/// A note for each outlet of one network that another, which was pruned, has no more.
std::vector<Finding> pruned_outlets(StreamNetwork const& before, StreamNetwork const& after);

/// The lines of a file.
RiversInPlan rivers_of_lines(Plan const& plan, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
