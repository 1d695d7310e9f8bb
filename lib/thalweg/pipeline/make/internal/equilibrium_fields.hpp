// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/channels.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/plan/plan.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

/// Private to this module.
namespace thalweg::pipeline {

/// Land, uplift and erodibility of terrain in equilibrium: from the recipe's files and its pattern of uplift.
surface::EquilibriumFields equilibrium_fields(Plan const& plan, Terrain const& terrain, Channels const& channels,
                                              Run const& run);

} // namespace thalweg::pipeline
