// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/pipeline/make/internal/diary.hpp>
#include <thalweg/pipeline/make/terrain.hpp>

/// Where rivers run, and how high. Private to this room.
namespace thalweg::pipeline {

/// Makes the network the recipe asks for, on its grid, with heights and the cells in which it runs.
void make_rivers(Terrain& terrain, Diary& diary, Run const& run);

/// Gives the rivers types, written to the arcs, where heights follow from them or the recipe asks for braided ones.
/// To be repeated when arcs are added or removed: types that arcs have stay.
void assign_types(StreamNetwork& plan, Terrain& terrain, Run const& run);

} // namespace thalweg::pipeline
