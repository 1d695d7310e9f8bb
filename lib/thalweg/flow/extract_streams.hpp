// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments.hpp>

// Idea: Streams begin where enough water has gathered: cells whose area reaches a support are
// channels, and D8 receivers join them to a forest. Nodes are cells where streams begin, meet or
// leave, arcs the cells between. support_for_length turns the question round: lengths are counted
// by octaves of area, then by the areas within the octave with the answer.
// Source: O'Callaghan and Mark 1984.
// Cost: O(n) for n cells, and O(s log s) for s cells of streams. One thread.
// Not for: channel heads, which a constant area misses: they depend on slope and ground. Arcs
// follow the grid and run straight in flats. A stream across a lake is one of many ways.
// Example:
//     ExtractedStreams const streams = extract_streams(flow_field, dem, {.support_km2 = 0.5});
//     StreamNetwork const& rivers = streams.network.planform;
// More: docs/measures.md.

namespace thalweg::flow {

/// A stream network extracted from a DEM, with its areas.
struct ExtractedStreams {
    ElevatedNetwork network; ///< along cell centres, at the DEM's heights: they may rise in a pit
    ContributingAreas areas;
    std::string crs; ///< of the DEM; "" for none
};

/// Options of extract_streams().
struct ExtractStreamsParams {
    std::int64_t support_cells = 200;       ///< [1, ...] contributing area at which streams begin
    std::optional<double> support_km2 = {}; ///< [km2] > 0, the same area, in place of support_cells
};

/// Finds the support for an area.
/// \param drainage flow field of the DEM
/// \param area_km2 [km2] > 0
/// \return [cells] the smallest support that is at least this large
/// \throws BadParameter when area_km2 is not a number above 0
std::int64_t support_for_area(FlowField const& drainage, double area_km2);

/// Extracts the network of cells whose D8 contributing area is at least the support.
/// \param drainage flow field of the DEM
/// \param dem [m] by cell; NaN: no data
/// \return nodes where streams begin, meet or leave the DEM, numbered by cell; arcs, numbered by the node they leave;
/// areas as areas_d8. A stream of one cell is omitted. Arcs meet only at nodes, except in flats, where two may cross at
/// a corner of cells.
/// \throws BadParameter when support_cells is below 1 or support_km2 not above 0
/// \throws BadInput when DEM and flow field differ in grid
///
/// Source: \cite ocallaghan1984.
ExtractedStreams extract_streams(FlowField const& drainage, Raster<float> const& dem,
                                 ExtractStreamsParams const& params = {}, Run const& run = {});

/// Finds the support for a total stream length.
/// \param drainage flow field of the DEM
/// \param length_m [m] > 0, total length of all streams
/// \return [cells] the largest support at which the extracted streams are at least this long; 1: they never are
/// \throws BadParameter when length_m is not a number above 0
std::int64_t support_for_length(FlowField const& drainage, double length_m, Run const& run = {});

} // namespace thalweg::flow
