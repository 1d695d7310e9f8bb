// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Makes sure of the law of a StreamNetwork before a stage relies on it.
/// Takes: a network and its index; who: the stage that asks ("network.order"), for the message.
/// Throws: BadInput, naming a node's or an arc's place: a node with two arcs leaving it, a cycle, a coordinate that is
/// not a number.
void require_trees(StreamNetwork const& network, std::string_view who);

} // namespace thalweg::network
