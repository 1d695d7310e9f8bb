// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/pipeline/make/network_story.hpp>
#include <thalweg/pipeline/make/river_file.hpp>
#include <thalweg/pipeline/plan/internal/diary.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

/// Where rivers run. Private to this room.
namespace thalweg::pipeline {

/// A network in plan on its grid, with the file's heights where lines carry them.
struct Planned {
    Recipe recipe; ///< with what follows from where the rivers come from: CRS, cell, turn, heights
    StreamNetwork plan;
    Grid grid;
    std::optional<ElevatedNetwork> file_heights = {};
    Mask land = {}; ///< 0: sea; without cells: all is land
    RiverFile file = {};
    NetworkStory story = {};
};

/// The lines that a recipe names.
RiverLines read_lines(Recipe const& recipe, Run const& run);

/// A recipe with the CRS and, where it is 0, the cell size of its grid by its lines.
struct OnLines {
    Recipe recipe;
    std::string why; ///< the cell has its size, as the end of a sentence; "" where it was given
};
OnLines settle_on_lines(Recipe recipe, RiverLines const& lines, Run const& run);

/// The tree that a recipe grows by Tokunaga's law.
network::TokunagaParams tree_of(Recipe const& recipe);

/// One arm of a cluster that grew by diffusion-limited aggregation, thinned and traced.
Planned plan_dla(Recipe recipe, Diary& diary, Run const& run);

/// Networks that branch by Tokunaga's law: one that fills the grid or a region, or one along each stroke of a file.
Planned plan_tokunaga(Recipe recipe, Diary& diary, Run const& run);

/// Trees that grow from a coast or border inland until the land is full of them. Every outlet lies there.
Planned plan_forest(Recipe recipe, Diary& diary, Run const& run);

/// A note for each outlet of one network that another, which was pruned, has no more.
std::vector<Finding> pruned_outlets(StreamNetwork const& before, StreamNetwork const& after);

/// The lines of a file. Decides heights that were left to the file.
Planned plan_lines(Recipe recipe, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
