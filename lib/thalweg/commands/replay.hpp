// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>

namespace thalweg::commands {

/// Options of run_replay().
struct ReplayParams {
    std::string folder; ///< written by make
};

/// Comparison of a folder with the current result of its recipe.
struct ReplayResult {
    std::vector<std::string> same;
    std::vector<std::string> differ;
    std::vector<std::string> missing; ///< in the folder
    bool verified() const { return differ.empty() && missing.empty(); }
};

/// Runs `thalweg replay`: makes FOLDER/recipe.toml in a temporary folder and compares the bytes of every file except
/// report.*; the folder is not changed.
/// \return the files that differ
/// \throws BadInput when there is no recipe; as make_terrain
ReplayResult run_replay(ReplayParams const& params, Run const& run = {});

} // namespace thalweg::commands
