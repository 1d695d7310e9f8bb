// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::pipeline {

/// Options of make_measures().
struct MakeMeasuresParams {
    std::string dem;                   ///< a folder written by make, or any raster of heights
    std::string network;               ///< "" takes that of the folder, if there is one
    io::ReadNetworkParams read;        ///< how the network is understood; it is reprojected to the DEM's CRS
    std::vector<std::string> what;     ///< names of measures; none takes d8, dinf and, with a network, catchments
    std::optional<double> nodata = {}; ///< of the DEM, as in io::ReadDemParams
};

/// How water leaves catchments aside.
struct MeasuredCatchments {
    io::CatchmentCount count;
    std::int64_t arcs = 0;          ///< of the network
    std::int64_t arcs_cut = 0;      ///< that leave the DEM
    std::int64_t arcs_outside = 0;  ///< that have no part on it
    std::int64_t arcs_nowhere = 0;  ///< of these, with a vertex that is not a number
    std::int64_t cells_without = 0; ///< whose water leaves the DEM before it meets a river
};

/// What make_measures() returns.
struct MadeMeasures {
    std::vector<std::string> files; ///< as they were written, folder included
    std::vector<std::string> notes; ///< what was left out, in words
    std::int64_t cells = 0;         ///< with data
    double area_m2 = 0.0;           ///< of these
    std::int64_t pits = 0;          ///< cells in depressions, through which water was led
    std::optional<double> d8_m2;    ///< greatest contributing area
    std::optional<double> dinf_m2;  ///< greatest contributing area
    std::optional<MeasuredCatchments> catchments;
};

/// Measures where a DEM's water goes, into files of a folder, whole or not at all: area_d8.tif and area_dinf.tif
/// (contributing areas [m2], the cell itself included), direction_d8.tif (Byte: 1 2 4 8 16 32 64 128 from the east
/// clockwise, 0 where water leaves, 255 without data) and direction_dinf.tif ([rad] counterclockwise from the east, -1
/// where water leaves), catchments.gpkg (of anyone's network). Depressions stay: water is led through them.
/// \param output a folder, which may hold other things
/// \param existing under replace a file of the same name is replaced, and nothing else
/// \return the files written
/// \throws BadParameter a name that is none (did you mean)
/// \throws BadInput catchments without a network, a DEM that is not in metres or has no CRS where the network has one,
/// a network beside the DEM or whose rivers run in a circle, a file that is there already
MadeMeasures make_measures(MakeMeasuresParams const& params, std::string const& output,
                           io::Existing existing = io::Existing::refuse, Run const& run = {});

/// A DEM whose cells are squares on the ground.
struct MetricDem {
    Raster<float> dem;
    std::vector<std::string> notes; ///< what was done, in words
};

/// Reads a DEM; one in degrees, or in metres whose lengths are off by more than 1 % (Web Mercator), is warped into
/// the UTM zone of its middle, onto cells as large as its own there; one with cells that are not square onto squares.
/// \param params as of io::read_dem
/// \return the DEM, and the cell size it had
/// \throws BadInput like read_dem, and where a geographic DEM lies in no UTM zone
MetricDem dem_in_metres(std::string const& path, io::ReadDemParams const& params = {}, Run const& run = {});

} // namespace thalweg::pipeline
