// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/growth/tokunaga/internal/embed_tree.hpp>

namespace thalweg::network {

/// A network of the links that stay.
struct KeptNetwork {
    NetworkDraft network;                          ///< its arcs run between sources, confluences and outlets
    std::vector<std::vector<LinkId>> links_of_arc; ///< by arc number, upstream first
};

/// Makes a network of links: one arc of those between which no other link enters.
/// Gives: arcs in the order of their lowest link.
KeptNetwork join_links(Forest const& forest, Indexed<LinkId, Vec2> const& at,
                       Indexed<LinkId, std::uint8_t> const& stays);

} // namespace thalweg::network
