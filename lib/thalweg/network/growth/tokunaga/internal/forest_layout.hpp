// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <thalweg/core/vec.hpp>
#include <thalweg/network/growth/tokunaga/internal/embed_tree.hpp>
#include <thalweg/network/planform/internal/segment_grid.hpp>

namespace thalweg::network {

inline constexpr std::size_t no_link = std::numeric_limits<std::size_t>::max();

/// A forest while its nodes are spread: where they lie and which of them take part yet.
/// Nodes are numbered by the links whose upper ends they are, then come the mouths of the trees.
struct ForestLayout {
    explicit ForestLayout(Forest const& wanted);

    Forest const& forest;
    std::size_t links;
    std::vector<Vec2> at;                     ///< [m] by node
    std::vector<std::vector<std::size_t>> up; ///< by node: the active links that end there
    std::vector<std::size_t> below;           ///< by link: the active node it ends in; no_link before it took part
    std::vector<std::uint8_t> active;         ///< by link: whether its node takes part
    std::vector<double> tree_spacing_m;       ///< by tree: root of its area for each active node
    std::vector<double> spacing_m;            ///< by link: that of its tree
    std::vector<std::vector<Vec2>> samples;   ///< by tree: places spread evenly over its land
    std::optional<SegmentGrid> placed;        ///< links that have a place, by number, then the walls

    bool is_mouth(std::size_t node) const { return node >= links; }
    bool is_pinned(std::size_t node) const { return is_mouth(node) || forest.links[node].pinned.has_value(); }
    Vec2 lower_end(std::size_t link) const { return at[below[link]]; }
    Segment segment(std::size_t link) const { return {at[below[link]], at[link]}; }

    /// Where a link ends, whether that node takes part or not.
    std::size_t node_below(std::size_t link) const;
    /// The lowest of the links that an active link stands for.
    std::size_t lowest_link(std::size_t link) const;
    /// The link that continues the stream above a node; no_link above a source or a fork.
    std::size_t main_above(std::size_t node) const;

    void place(std::size_t link, Vec2 to);
    void move(std::size_t link, Vec2 to);
};

/// A vector of length 1; to the north for (0, 0).
Vec2 direction_of(Vec2 a);

/// Makes the streams of an order take part: nodes on streams that are there already are set at equal distances, sources
/// of new ones near the nodes they drain to.
void admit_streams(ForestLayout& layout, int order);

/// Whether a node is new or only moves: what moves may stay as near to others as it was.
enum class Placement : std::uint8_t { first, move };

/// Whether the node of a link may lie at `to`: its links keep the clearance from all but their neighbours, and those
/// that share a node enclose 20 degrees at least.
bool may_lie(ForestLayout const& layout, std::size_t link, Vec2 to, Placement placement);

/// Moves every free node once: towards the centres of the places nearest to it and to its links, towards a straight
/// course, tributaries upstream, and at random in the first sweeps. progress: [0, 1) of the sweeps of this order.
void relax_nodes(ForestLayout& layout, int order, int sweep, double progress);

} // namespace thalweg::network
