// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <span>
#include <string>
#include <vector>

#include <thalweg/core/river_files.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

/// A condition on the rivers' file.
struct LinesCondition {
    bool (*holds)(RiverLines const& lines) = nullptr; ///< null: for any file
    char const* words = "";                           ///< the file "has coastlines"
};

/// A step of make. This is the one place that says when it runs and what it costs: make asks it, and forecasts,
/// progress, timings and `thalweg recipe --json` have its name.
struct Stage {
    char const* name;
    double seconds_a_million; ///< of cells, on one core of 2020; estimated
    double bytes_a_cell;      ///< that the program takes at its peak here, beside its rivers and files of what is done;
                              ///< estimated with two threads, from peak_mb of report.json
    Condition when;           ///< on a recipe with its defaults
    LinesCondition lines = {};

    /// \param recipe with its defaults
    /// \param of_file lines of the rivers' file
    bool runs(Recipe const& recipe, RiverLines const& of_file = {}) const {
        return when(recipe) && (lines.holds == nullptr || lines.holds(of_file));
    }
    /// In words.
    std::string runs_if() const;
};

/// The stages. timings_s of report.json has these names.
namespace stage {
extern Stage const raster, read, shape, grow, thin, trace, embed, adopt, sea, prune, meander, raise;
extern Stage const channels, fill_in_equilibrium, fill_in_layers, fill_with_heights, fill_rebuilt, scatter, ridge, tin,
    fill_dilated, fill, land, detail, project;
extern Stage const blend; ///< once for each patch
extern Stage const carve, drain, valleys, measure, certify, ridges, areas, laws, relief, catchments, check, compare;
} // namespace stage

/// All of them, in the order in which they run.
std::span<Stage const* const> all_stages();

/// The stages that run, in order; blend once for each patch.
/// \param recipe with its defaults
/// \param lines of the rivers' file
std::vector<Stage const*> stages_of(Recipe const& recipe, RiverLines const& lines);

} // namespace thalweg::recipe
