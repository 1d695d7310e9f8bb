// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Copies heights between networks with the same vertices; new vertices, downstream of the known ones, go on with the
/// slope of their river's last kilometre, or less where it is shorter.
/// \param network has every vertex of `known`, and may continue downstream (carry_outlets)
/// \param known a network with heights
/// \return `network` with heights
/// \throws BadInput when a vertex without a height has none upstream either
ElevatedNetwork keep_heights(StreamNetwork const& network, ElevatedNetwork const& known);

} // namespace thalweg::network
