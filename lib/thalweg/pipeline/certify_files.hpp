// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/network_file.hpp>
#include <thalweg/core/run.hpp>
#include <thalweg/measure/certificate.hpp>

namespace thalweg::pipeline {

/// The drainage certificate of a DEM file and a network, anyone's. Parts of the network beside the DEM are findings
/// (outside_dem), and do not count otherwise. Parts of rivers that are drawn level stand as lakes do; nodes of the kind
/// "sink" end their rivers. honoured: a raster of the cells in which the DEM honours the rivers, above 0; "": in all.
/// Throws: BadInput when a raster cannot be read or they have different grids, the two have different CRS or only one
/// has any, or no arc lies on the DEM; what reaches_of_file throws for a network without direction; IoError; Cancelled.
measure::Certificate certify_files(NetworkFile const& network, std::string const& dem, std::string const& honoured,
                                   Run const& run = {});

} // namespace thalweg::pipeline
