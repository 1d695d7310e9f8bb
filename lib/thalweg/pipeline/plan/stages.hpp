// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <chrono>
#include <exception>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/pipeline/plan/plan.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

/// Measures what work of this thread takes.
class Stopwatch {
public:
    StageTime time_of(char const* stage) const {
        std::chrono::duration<double> const taken = std::chrono::steady_clock::now() - begin_;
        return {stage, taken.count(), cpu_seconds() - cpu_begin_s_};
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    double cpu_begin_s_ = cpu_seconds();
};

/// Times the stages, logs a line for each and collects what they find. When an error ends the work, what was found so
/// far is reported.
class StageLog {
public:
    explicit StageLog(Run const& run) : run_(run) {}
    ~StageLog();
    StageLog(StageLog const&) = delete;
    StageLog& operator=(StageLog const&) = delete;

    template <class Stage> auto stage(char const* name, Stage&& work) {
        run_.at(0.0, name);
        Stopwatch const stopwatch;
        auto result = work();
        timings_s_.push_back(stopwatch.time_of(name));
        run_.at(1.0, name);
        return result;
    }
    /// Logs a line about the last stage.
    void say(std::string const& words) const;

    /// Adds times of stages that ran before.
    void add(Timings const& timings_s) { timings_s_.insert(timings_s_.end(), timings_s.begin(), timings_s.end()); }
    /// Returns the times of the stages, in order, and clears them.
    Timings take() { return std::exchange(timings_s_, {}); }

    void find(Finding finding) { findings_.push_back(std::move(finding)); }
    void find(std::vector<Finding> const& findings) {
        findings_.insert(findings_.end(), findings.begin(), findings.end());
    }
    /// Returns the findings, in order, and clears them.
    std::vector<Finding> take_findings() { return std::exchange(findings_, {}); }

private:
    Run const& run_;
    int exceptions_ = std::uncaught_exceptions();
    Timings timings_s_;
    std::vector<Finding> findings_;
};

// Predicates for the stages of a plan, common to make, which runs them, and the forecast, which lists them.

/// Whether coastlines of the rivers' file bound the land.
bool has_coastlines(Plan const& plan);

/// Whether rivers go through the meander stage.
bool has_meanders(Plan const& plan);

/// Whether rivers take their heights from the terrain.
bool heights_follow_terrain(Recipe const& recipe);

/// Whether rivers take their heights from a DEM that is the terrain.
bool heights_follow_raster(Recipe const& recipe);

/// Whether random points lie between the rivers, or in the terrain.
bool scatters_points(Recipe const& recipe);

/// Whether ridges are drawn between the rivers.
bool has_ridges(Recipe const& recipe);

/// Whether rivers, ridges and points are triangulated.
bool needs_tin(Recipe const& recipe);

/// Whether the terrain is conditioned hydrologically.
bool conditions_dem(Recipe const& recipe);

/// Whether the catchments of the arcs are found.
bool finds_catchments(Recipe const& recipe);

/// Whether contributing areas are measured by cell.
bool measures_areas(Recipe const& recipe);

/// Whether the terrain's own side valleys become arcs.
bool adds_side_valleys(Recipe const& recipe);

// Networks that branch by Tokunaga's law.

/// Advice if links find no room.
inline constexpr char const* more_room =
    "lower network.tokunaga.order or spacing, or take a larger grid (or smaller cells)";

/// The tree that a recipe grows by Tokunaga's law.
network::TokunagaParams tree_of(Recipe const& recipe);

/// Rejects lines of which one vertex, or at most 1 %, is more than twenty times as far away as all others: a corrupt
/// coordinate that would enlarge the grid. Fewer than 20 vertices are not judged.
/// \throws BadInput naming the line, the vertex and the remedy
void require_no_stray_vertex(RiverLines const& lines);

/// The requested grid, or the points' box and 5 % around it on multiples of the cell.
Grid frame_land(FeaturePoints const& points, GridRecipe const& wanted);

/// Throws BadInput naming the first point off the grid. name: the file, as in the recipe.
void require_on_grid(FeaturePoints const& points, Grid const& grid, std::string const& name);
/// The same for the points and ridges of a plan.
void require_skeleton_on_grid(Plan const& plan, Grid const& grid);

/// Appends the values of one vector to another.
template <class T> void append(std::vector<T>& to, std::vector<T> from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

} // namespace thalweg::pipeline
