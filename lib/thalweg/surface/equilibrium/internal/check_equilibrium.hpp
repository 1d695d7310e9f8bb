// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/equilibrium.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Throws: BadParameter, BadInput as equilibrium().
void check_equilibrium(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params);

} // namespace thalweg::surface
