// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Gives a network the heights that another with the same vertices has; vertices that only this one has (an outlet
/// carried on) fall with a slope from the last known one.
/// \pre known, with every vertex of network but those downstream of its last known ones.
/// \param network the network
/// \param known a network with heights
/// \param slope [m/m] > 0
/// \return the network with heights
/// \throws BadInput when a vertex without a height has none upstream either
ElevatedNetwork keep_heights(StreamNetwork const& network, ElevatedNetwork const& known, double slope);

} // namespace thalweg::network
