// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>

namespace thalweg::network {

/// Options of embed_tree().
struct EmbedParams {
    std::uint64_t seed = 7;
    std::vector<Vec2> region = {}; ///< [m] ring of the land to fill, either way round, not closed
    Vec2 mouth = {};               ///< [m] outlet, on the ring or inside
    Vec2 direction = {};           ///< of the trunk at the outlet, upstream; (0, 0): towards the middle of the region
    double clearance = 0.35;       ///< [0.05, 0.35] links that share no node keep apart by this share of the shorter
    double min_spacing_m = 0.0;    ///< [m] >= 0 and at least by this; 0: no other bound
};

/// What embed_tree() returns.
struct EmbeddedTree {
    StreamNetwork network;                         ///< arcs between outlet, confluences and sources
    std::vector<std::vector<LinkId>> links_of_arc; ///< by arc number: links of the tree, upstream first; one a
                                                   ///< piece of the line, but where streams of the lowest
                                                   ///< orders are left out
    std::int64_t placed = 0;                       ///< links
    std::int64_t dropped = 0;                      ///< links for which there was no room, with all above them
    double spacing_m = 0.0;                        ///< [m] root of the region's area for each link
};

/// Lays a tree into a region and fills it evenly.
/// \param tree a binary tree and a region with the outlet's place
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return a network in which no two arcs meet but in shared nodes. Links that share no node keep apart by clearance *
/// the length of the shorter and by min_spacing_m, those that do meet at 20 degrees at least; links for which this
/// cannot be kept are left out with all above them, streams of high order last; where min_spacing_m is more than so
/// many links can keep, the streams of the lowest orders. Coordinates are rounded to 1e-6 m. Random numbers are a hash
/// of (seed, order and link). \throws BadParameter when the region is not a ring of at least three different places,
/// crosses itself, is too small for so many links (spacing below 1e-3 m), or the outlet lies outside \throws Cancelled
///
/// Source: \cite nenu2015, section 2.2, figure 1 (a); order first, evened out by \cite lloyd1982.
EmbeddedTree embed_tree(TokunagaTree const& tree, EmbedParams const& params, Run const& run = {});

/// \param grid the grid
/// \return the ring of a grid's outer edges, to be used as a region.
std::vector<Vec2> outline(Grid const& grid);

} // namespace thalweg::network
