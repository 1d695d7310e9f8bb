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
#include <thalweg/measure/rivers/profiles.hpp>

namespace thalweg::commands {

/// Options of run_measure().
struct MeasureParams {
    std::string dem;                              ///< a folder written by make, or any raster of heights
    std::string output;                           ///< a folder, which may have other content
    io::Existing existing = io::Existing::refuse; ///< replace: files of the same name are replaced, nothing else
    std::string network;                          ///< "": the folder's own, if any
    io::ReadNetworkParams read;                   ///< how the network is read; it is reprojected to the DEM's CRS
    std::vector<std::string> what;      ///< names of measures; empty: d8, dinf and, with a network, catchments; "all"
    io::ReadDemParams reading = {};     ///< how the DEM is read
    std::int64_t support_cells = 200;   ///< [1, ...] contributing area at which streams begin
    std::optional<double> theta = 0.45; ///< [0, 2] concavity index of chi; nothing: fitted
    measure::SteepnessParams steepness = {}; ///< of less than three cells: three cells
    measure::KnickpointParams knickpoint = {};
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

/// The rivers whose profiles were measured.
struct MeasuredStreams {
    std::int64_t arcs = 0;      ///< that have a part on the DEM
    std::int64_t arcs_edge = 0; ///< whose contributing area may reach beyond the data
    std::int64_t knickpoints = 0;
    double theta = 0.0;
    std::optional<double> theta_r2; ///< of a fitted theta
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
    std::optional<MeasuredStreams> streams;
    std::optional<std::int64_t> edge_cells; ///< whose contributing area may reach beyond the data
};

/// Runs `thalweg measure`: routes flow over a DEM and writes what is asked for to a folder, completely or not at all.
/// Depressions are not filled: water is routed through them. Rivers are those of the network or, without one, the cells
/// that support_cells drain through. A DEM that is not in squares of metres is warped as by read_drawable, and all
/// files are in its new CRS. The measures:
/// * d8, dinf: area_d8.tif, area_dinf.tif (contributing areas [m2], the cell itself included);
/// * directions: direction_d8.tif (Byte: 1 2 4 8 16 32 64 128 from the east clockwise, 0: water leaves, 255: no data),
///   direction_dinf.tif ([rad] counterclockwise from the east, -1: water leaves);
/// * edge: edge.tif (Byte: 1 where the contributing area may reach beyond the data, 255: no data);
/// * lengths: length_up.tif, length_down.tif ([m] longest D8 flow path from a divide, path to where water leaves);
/// * hand: hand.tif ([m] above the first river cell on the D8 flow path);
/// * twi: twi.tif (measure::wetness of the D-infinity areas);
/// * orders: strahler.tif, shreve.tif (of the cells that support_cells drain through);
/// * chi: chi.tif, ksn.tif (by river cell);
/// * streams: streams.gpkg (layers arcs and knickpoints);
/// * catchments: catchments.gpkg (of the network's arcs and of their basins, with their relief and Pfafstetter codes).
/// \return the files written
/// \throws BadParameter for an unknown name (with a suggestion), and as the functions of flow and measure
/// \throws BadInput for catchments without a network, a DEM without a CRS if the network has one, a network off the DEM
/// or with a cycle, or a file that exists already
MeasureResult run_measure(MeasureParams const& params, Run const& run = {});

} // namespace thalweg::commands
