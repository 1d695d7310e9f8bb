// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/channels/lakes.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::make {

/// Channels with the requested lakes.
struct WithLakes {
    network::ChannelsOfArcs rivers;
    std::vector<network::Lake> lakes = {};
    std::vector<Finding> notes = {};
    bool by_levels = false; ///< some have levels: channels.lake_z
};

/// Adds the lakes of surface.lakes or surface.lake_share to channels; without either they stay as they are.
/// \throws BadInput for a level farther than 100 000 m from 0
WithLakes with_lakes(recipe::Recipe const& recipe, Planform const& planform, network::ChannelsOfArcs rivers,
                     Run const& run);

} // namespace thalweg::make
