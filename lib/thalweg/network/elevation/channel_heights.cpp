// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/channel_heights.hpp>

#include <cstddef>

#include <thalweg/network/vectorise/rasterise.hpp>

namespace thalweg::network {

std::vector<float> channel_heights(ElevatedNetwork const& network, Channels const& channels) {
    Raster<float> const drawn = rasterise(network, channels.grid).valley.z;
    Indexed<ChannelId, float> z;
    z.reserve(channels.cell.size());
    for (std::int64_t const cell : channels.cell) {
        z.push_back(drawn[cell]);
    }
    for (std::size_t i = z.size(); i-- > 0;) { // donors before their receivers
        if (channels.receiver[i] >= 0) {
            float& below = z[channels.receiver[i]];
            below = z[i] < below ? z[i] : below;
        }
    }
    return z;
}

} // namespace thalweg::network
