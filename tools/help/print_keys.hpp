// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::tools {

/// The keys a word stands for: all for "", one for its path, all of a section for the section's name (with or without
/// brackets), or all of that name in any section. Throws BadParameter for another word, with what was probably meant.
std::vector<pipeline::KeyHelp> keys_named(std::string const& word);

/// Keys by section, with unit, range and default.
std::string keys_as_list(std::vector<pipeline::KeyHelp> const& keys);

/// One key with all that is known of it.
std::string key_as_text(pipeline::KeyHelp const& key);

/// One JSON object: "keys", an array of objects.
std::string keys_as_json(std::vector<pipeline::KeyHelp> const& keys);

} // namespace thalweg::tools
