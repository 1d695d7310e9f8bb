// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Heights of the cells in which rivers run, from those of the rivers.
/// \pre a network with heights and the channels of its plan.
/// \param network the network
/// \param channels the channels
/// \return by number what rasterise draws there, lowered where the way of the water rises: no cell stands below its
/// receiver; NaN where no arc of the network runs.
/// \throws Error as rasterise
std::vector<float> channel_heights(ElevatedNetwork const& network, Channels const& channels);

} // namespace thalweg::network
