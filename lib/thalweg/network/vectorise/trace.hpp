// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Options of trace().
struct TraceParams {
    /// [m] each component drains to its nearest cell (ties: lower index); rounded to 2^-16 of a cell
    Required<Vec2> mouth;
};

/// Traces a skeleton into a network: the shortest-path tree from each component's outlet cell (steps 1 and sqrt 2; ties
/// by index).
/// \param skeleton one cell wide; a diagonal step counts only if neither orthogonal cell beside it is set (m-adjacency)
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return nodes are outlets and cells with no or several cells upstream; arcs have one vertex per cell centre; both
/// are numbered by cell index (arcs by that of their upstream end). A component of one cell is left out.
/// \throws BadInput for a skeleton without two adjacent cells
/// \throws BadParameter for a mouth that is not a position
///
/// Source: \cite cao2009, section 3.2; specification 0.2.
StreamNetwork trace(Mask const& skeleton, TraceParams const& params, Run const& run = {});

} // namespace thalweg::network
