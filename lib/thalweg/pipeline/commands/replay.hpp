// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>

namespace thalweg::pipeline {

/// How a folder compares with what its recipe makes now.
struct Replayed {
    std::vector<std::string> same;
    std::vector<std::string> differ;
    std::vector<std::string> missing; ///< in the folder
    bool verified() const { return differ.empty() && missing.empty(); }
};

/// Makes FOLDER/recipe.toml again beside it and compares the bytes of every file but report.*; the folder is not
/// touched.
/// \return the files that differ
/// \throws BadInput when there is no recipe; what make_terrain throws
Replayed replay(std::string const& folder, Run const& run = {});

} // namespace thalweg::pipeline
