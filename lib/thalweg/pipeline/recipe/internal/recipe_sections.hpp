// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

/// The keys of one section each, in the order of recipe files. Private to this room.
namespace thalweg::pipeline {

void add_forest_keys(std::vector<Key>& keys);
void add_network_keys(std::vector<Key>& keys);
void add_skeleton_keys(std::vector<Key>& keys);
void add_surface_keys(std::vector<Key>& keys);
void add_statistics_keys(std::vector<Key>& keys);
void add_detail_keys(std::vector<Key>& keys);
void add_patch_keys(std::vector<Key>& keys);

} // namespace thalweg::pipeline
