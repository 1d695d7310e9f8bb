// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Converts the heights of rivers to heights of channel cells.
/// \param network the rivers, with heights
/// \param channels channels of this network
/// \return [m] by channel cell: as rasterise, lowered so that no receiver is above its donor; NaN where no arc runs
/// \throws BadInput as rasterise
std::vector<float> channel_heights(ElevatedNetwork const& network, Channels const& channels);

} // namespace thalweg::network
