// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/stream_network.hpp>

/// Common to pruning and shortening.
namespace thalweg::network {

/// Which nodes with one arc in and one out are merged.
enum class Merge : std::uint8_t {
    all,
    new_ones ///< only nodes that had more arcs
};

/// A selection of a network's arcs.
struct KeptArcs {
    NetworkDraft network;
    std::vector<std::vector<std::size_t>> pieces; ///< by arc: numbers of the arcs it consists of, downstream
};

/// Keeps some arcs and merges those left in pairs at a node; arcs and nodes keep their order. lengths: by arc; kept: 1:
/// the arc and everything downstream are kept. A merged arc has the feature and type of its longest piece, and the
/// other attributes of its first.
KeptArcs keep_arcs(StreamNetwork const& network, std::vector<std::int64_t> const& lengths,
                   std::vector<std::uint8_t> const& kept, Merge merge = Merge::all);

} // namespace thalweg::network
