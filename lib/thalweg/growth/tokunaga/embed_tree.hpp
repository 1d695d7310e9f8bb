// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>

// Idea: A topology says which link joins which, not where. Streams of the highest order are placed
// first; after each order all nodes move for some sweeps towards the centres of the land nearest to
// them (Lloyd's method) and towards straight courses, so that links of all orders fill the region
// evenly. A step that would bring a link too near to another is not taken, hence links that do not
// cross never come to cross. In the end a second pass settles links in order of importance: one
// that is too close to another, or meets it at less than 20 degrees, tries other places, and is
// left out with all above it if none fits.
// Source: the tree of Northeast Normal University 2015, section 2.2, whose fixed turns let 13 to 31
// % of links cross; evened out by Lloyd 1982. The method is ours: docs/decisions/0010-embedding.md.
// Cost: for n links about 40 sweeps of O(n) for order 1, which holds most of them; 21 845 links
// take 5 to 10 s. One thread, since every move depends on those before it. Trees of at most 5000
// links that lose more than 2 % are tried from up to six seeds.
// Not for: given lengths of links; they follow from the room. Courses are straighter than those of
// real rivers (network/planform/meander.hpp bends them). One trunk along a drawn line:
// grow_strokes.hpp.
// Example:
//     TokunagaTree const tree = grow_tokunaga({.order = 6});
//     Vec2 const mouth{0.5 * (grid.west + grid.east()), grid.south()};
//     EmbeddedTree const drawn = embed_tree(tree, {.region = outline(grid), .mouth = mouth});
//     StreamNetwork const& rivers = drawn.network; // drawn.dropped links found no room
// More: docs/algorithms/forest_spreading.md.

namespace thalweg::growth {

/// Options of embed_tree().
struct EmbedParams {
    std::uint64_t seed = 7;
    std::vector<Vec2> region = {}; ///< [m] ring of the area to fill, either orientation, not closed
    Vec2 mouth = {};               ///< [m] outlet, on the ring or inside it
    Vec2 direction = {};           ///< of the trunk at the outlet, upstream; (0, 0): towards the region's centre
    /// [0.05, 0.35] least distance of links without a common node, relative to the shorter one
    double clearance = 0.35;
    double min_spacing_m = 0.0; ///< [m] >= 0, their least distance; 0: no limit
};

/// What embed_tree() returns.
struct EmbeddedTree {
    StreamNetwork network; ///< arcs between outlet, confluences and sources
    /// by arc: links of the tree, upstream; one per piece of the line, unless streams of the lowest orders are left out
    std::vector<std::vector<LinkId>> links_of_arc;
    std::int64_t placed = 0;  ///< number of links
    std::int64_t dropped = 0; ///< links without room, with all upstream of them
    double spacing_m = 0.0;   ///< [m] square root of the region's area per link
};

/// Embeds a tree evenly in a region. Links for which the distances cannot be kept are left out with all upstream of
/// them, streams of high order last; if min_spacing_m is too large for so many links, streams of the lowest orders.
/// \param tree a binary tree of links
/// \return arcs meet only at shared nodes. Links without a common node keep clearance times the shorter one's length
/// and min_spacing_m apart; others meet at 20 degrees or more. Coordinates are rounded to 1e-6 m. Random numbers are a
/// hash of (seed, order, link).
/// \throws BadParameter when the region is not a simple ring of at least three different points, is too small (spacing
/// below 1e-3 m) or does not contain the outlet
///
/// Source: \cite nenu2015, section 2.2, figure 1 (a); order first, evened out by \cite lloyd1982.
EmbeddedTree embed_tree(TokunagaTree const& tree, EmbedParams const& params, Run const& run = {});

/// The outer edge of a grid, as a region for embed_tree.
/// \param grid any grid
/// \return [m] its four corners
std::vector<Vec2> outline(Grid const& grid);

} // namespace thalweg::growth
