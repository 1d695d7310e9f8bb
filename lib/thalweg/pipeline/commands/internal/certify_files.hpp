// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/measure/drainage/certificate.hpp>

namespace thalweg::pipeline {

/// Rasters beside a network, of which cells above 0 count; "" for none. Those on another grid than the DEM's are passed
/// over.
struct RiverRasters {
    std::string drawn = {}; ///< cells into which rivers were drawn
    std::string lakes = {}; ///< cells of lakes
    bool waive = false;     ///< only drawn cells are to be honoured: patches took the place of others
};

/// A DEM.
struct DemFile {
    std::string path;
    std::optional<double> nodata = {}; ///< as in io::ReadDemParams
};

/// The drainage certificate of a DEM file and a network, anyone's. Parts of the network beside the DEM are findings
/// (outside_dem), and do not count otherwise. Parts of rivers that are drawn level stand as lakes do; nodes of the kind
/// "sink" end their rivers.
/// Throws: BadInput when a raster cannot be read, the network and the DEM have different CRS or only one has any, or no
/// arc lies on the DEM; what reaches_of_file throws for a network without direction; IoError; Cancelled.
measure::Certificate certify_files(NetworkFile const& network, DemFile const& file, RiverRasters const& rasters = {},
                                   Run const& run = {});

} // namespace thalweg::pipeline
