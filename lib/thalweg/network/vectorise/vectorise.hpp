// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

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
/// Source: \cite cao2009, section 3.2; specification 0.2.
StreamNetwork trace(Mask const& skeleton, TraceParams const& params, Run const& run = {});

} // namespace thalweg::network
