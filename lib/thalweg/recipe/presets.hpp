// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

/// Values of keys that together give land of one kind.
struct Preset {
    std::string name;           ///< "hills"
    std::string meaning;        ///< for people: what the land is
    std::string not_meant;      ///< and what one may expect of the name in vain
    std::vector<KeyValue> keys; ///< of the land, none of its rivers; all have a value
};

/// \return every preset of `make --preset`.
std::vector<Preset> const& presets();

/// Gives a recipe the values of a preset, but for keys that its file or set_key() has set. Keys of the preset that
/// what is set leaves no effect are left out: surface.mean_slope beside surface.relief.
/// \param recipe with terrain in equilibrium
/// \param name of a preset
/// \return the recipe
/// \throws BadParameter when no preset has the name (did you mean), when the terrain is not in equilibrium, and when the
/// recipe sets every key of the preset
Recipe with_preset(Recipe recipe, std::string const& name);

} // namespace thalweg::recipe
