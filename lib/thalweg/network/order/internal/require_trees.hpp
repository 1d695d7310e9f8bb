// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Checks that a network is a forest before a stage relies on it.
/// \param network any
/// \param who "network.order", for the message
/// \throws BadInput naming the position of a node with two outflowing arcs, of a cycle, or of a coordinate that is not
/// a number
void require_trees(StreamNetwork const& network, std::string_view who);

} // namespace thalweg::network
