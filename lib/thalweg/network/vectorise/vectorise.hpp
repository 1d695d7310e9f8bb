// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: A cluster of cells becomes lines in two steps. thin() takes cells off the rim as long as
// the rest stays connected: a cell goes if its set neighbours form one component and it is not the
// end of a branch. Cells are taken from two opposite sides in turn, since both at once would erase
// a line of two cells; 64 cells are decided at a time by logic on words, and only words beside a
// change are looked at again. trace() then runs Dijkstra from the outlet over the skeleton: the
// shortest-path tree has no loops, and drains to the outlet. Cells with one cell upstream lie
// within an arc, all others are nodes.
// Source: Guo and Hall 1989, algorithm A1 (thinning); Cao, Long and Lü 2009, section 3.2, which
// leaves the vectorisation open; m-adjacency and the tree are ours.
// Cost: thinning is O(cells) a pass, with a pass for each layer of cells (docs/performance.md: 3.4
// ns and 6.8 bytes a cell for 1024 x 1024). Tracing is O(s log s) for s cells of the skeleton. One
// thread.
// Not for: the streams of a DEM (flow/extract_streams.hpp), which have directions already; networks
// of grow_forest, which are lines from the start. A loop is cut where its two ways are equally
// long.
// Example:
//     Mask const skeleton = thin(cluster_mask);
//     StreamNetwork const rivers = trace(skeleton, {.mouth = grid.centre({120, 80})});
// More: docs/rivers.md; prune.hpp takes off the burrs that a skeleton has.

namespace thalweg::network {

/// Thins a mask to its skeleton.
/// \param mask 0: outside, as is everything beyond the grid
/// \return a subset one cell wide with as many components (8-connected) and holes (4-connected) as the mask, without
/// L-shaped corners; thinning again changes nothing. Four branches may meet in a block of 2 x 2 cells.
///
/// Source: \cite guo1989, algorithm A1, 64 cells a word.
Mask thin(Mask const& mask, Run const& run = {});

/// Options of trace().
struct TraceParams {
    /// [m] each component drains to its nearest cell (ties: lower index); rounded to 2^-16 of a cell
    Required<Vec2> mouth;
};

/// Traces a skeleton into a network: the shortest-path tree from each component's outlet cell (steps 1 and sqrt 2; ties
/// by index).
/// \param skeleton one cell wide; a diagonal step counts only if neither orthogonal cell beside it is set (m-adjacency)
/// \return nodes are outlets and cells with no or several cells upstream; arcs have one vertex per cell centre; both
/// are numbered by cell index (arcs by that of their upstream end). A component of one cell is left out.
/// \throws BadInput for a skeleton without two adjacent cells
/// \throws BadParameter for a mouth that is not a position
///
/// Source: \cite cao2009, section 3.2.
StreamNetwork trace(Mask const& skeleton, TraceParams const& params, Run const& run = {});

} // namespace thalweg::network
