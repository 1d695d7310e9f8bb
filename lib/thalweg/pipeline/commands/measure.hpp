// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::pipeline {

/// Options of run_measure().
struct MeasureParams {
    std::string dem;                              ///< a folder written by make, or any raster of heights
    std::string output;                           ///< a folder, which may have other content
    io::Existing existing = io::Existing::refuse; ///< replace: files of the same name are replaced, nothing else
    std::string network;                          ///< "": the folder's own, if any
    io::ReadNetworkParams read;                   ///< how the network is read; it is reprojected to the DEM's CRS
    std::vector<std::string> what;  ///< names of measures; empty: d8, dinf and, with a network, catchments
    io::ReadDemParams reading = {}; ///< how the DEM is read
};

/// Arcs and cells that the catchments leave out.
struct MeasuredCatchments {
    io::CatchmentCount count;
    std::int64_t arcs = 0;          ///< of the network
    std::int64_t arcs_cut = 0;      ///< that leave the DEM
    std::int64_t arcs_outside = 0;  ///< that lie completely outside
    std::int64_t arcs_nowhere = 0;  ///< of these: with a vertex that is not a number
    std::int64_t cells_without = 0; ///< whose water leaves the DEM before it reaches a river
};

/// What run_measure() returns.
struct MeasureResult {
    std::vector<std::string> files; ///< paths, folder included
    std::vector<Finding> findings;  ///< omissions
    std::int64_t cells = 0;         ///< with data
    double area_m2 = 0.0;           ///< of these
    std::int64_t pits = 0;          ///< cells in depressions, through which water is routed
    std::optional<double> d8_m2;    ///< largest contributing area
    std::optional<double> dinf_m2;  ///< largest contributing area
    std::optional<MeasuredCatchments> catchments;
};

/// Runs `thalweg measure`: routes flow over a DEM and writes the results to a folder, completely or not at all:
/// area_d8.tif and area_dinf.tif (contributing areas [m2], the cell itself included), direction_d8.tif (Byte: 1 2 4 8
/// 16 32 64 128 from the east clockwise, 0: water leaves, 255: no data) and direction_dinf.tif ([rad] counterclockwise
/// from the east, -1: water leaves), catchments.gpkg (of any network). Depressions are not filled: water is routed
/// through them.
/// \return the files written
/// \throws BadParameter for an unknown name (with a suggestion)
/// \throws BadInput for catchments without a network, a DEM that is not in metres, or without a CRS if the network has
/// one, a network off the DEM or with a cycle, or a file that exists already
MeasureResult run_measure(MeasureParams const& params, Run const& run = {});

} // namespace thalweg::pipeline
