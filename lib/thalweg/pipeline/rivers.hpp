// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/pipeline/diary.hpp>
#include <thalweg/pipeline/terrain.hpp>

/// Where rivers run, and how high. Private to this room.
namespace thalweg::pipeline {

/// Makes the network the recipe asks for, on its grid, with heights and the cells in which it runs.
void make_rivers(Terrain& terrain, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
