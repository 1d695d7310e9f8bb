// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/elevation/assign_types.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

/// Private to this module.
namespace thalweg::pipeline {

/// A network whose arcs say their types.
struct Typed {
    StreamNetwork plan;
    network::RiverTypes types; ///< by arc; empty where rivers have none
};

/// Gives the rivers types, written to the arcs, where heights follow from them or the recipe asks for braided ones.
/// To be repeated when arcs are added or removed: types that arcs have stay.
Typed type_rivers(StreamNetwork plan, NetworkRecipe const& wanted, Run const& run);

} // namespace thalweg::pipeline
