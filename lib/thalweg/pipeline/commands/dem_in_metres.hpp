// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::pipeline {

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
