// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/stream_network.hpp>

/// What pruning and shortening share.
namespace thalweg::network {

/// Which nodes of one arc in and one out are merged.
enum class Merge : std::uint8_t {
    all,
    new_ones ///< those that had more arcs
};

/// Some arcs of a network.
struct KeptArcs {
    NetworkDraft network;
    std::vector<std::vector<std::size_t>> pieces; ///< by arc: the arcs it was made of, by number, downstream
};

/// The arcs kept, merged where two are left at a node; numbers of arcs and nodes keep their order.
/// Takes: a network and its index; by arc a length and whether it is kept (1), with all below it. Gives: a merged arc
/// has the feature and type of its longest piece, and what else belongs to its first.
KeptArcs keep_arcs(StreamNetwork const& network, std::vector<std::int64_t> const& lengths,
                   std::vector<std::uint8_t> const& kept, Merge merge = Merge::all);

} // namespace thalweg::network
