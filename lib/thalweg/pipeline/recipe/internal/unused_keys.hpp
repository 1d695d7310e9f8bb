// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/pipeline/recipe/recipe.hpp>

/// Keys that are set and have no effect. Private to this module.
namespace thalweg::pipeline {

/// A key that has no effect in a recipe though it is set.
struct UnusedKey {
    std::string path;  ///< "patch.2.rivers" of the second patch
    std::string words; ///< for people: the value, where it is set, and what has to change for it to have an effect
};

/// Keys without an effect whose value is neither their default nor that of an earlier version, in the order of recipe
/// files.
std::vector<UnusedKey> unused_keys(Recipe const& recipe);

/// The same of keys that a file or --set has set, once the recipe has every default resolved.
/// Throws: BadParameter that names them.
void refuse_unused_keys(Recipe const& resolved);

} // namespace thalweg::pipeline
