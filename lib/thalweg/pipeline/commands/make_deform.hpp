// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <thalweg/blend/deform.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::pipeline {

/// Options of make_deform().
struct MakeDeformParams {
    std::string target = {};           ///< a DEM
    std::string mask = {};             ///< the region: a raster on the target's grid, or polygons
    double scale = 1.0;                ///< as in blend::DeformParams
    std::vector<Vec3> handles = {};    ///< [m] places in the region and the heights to which they are pulled
    std::optional<double> nodata = {}; ///< of the DEM, as in io::ReadDemParams
};

/// Reads a DEM and bends a region of it.
/// \param params files
/// \param run progress, log, stop token and number of threads
/// \return as blend::deform.
/// \throws BadParameter
/// \throws BadInput as the stage and the doors do, also when a handle lies outside the target or no change is set
/// \throws NotConverged
/// \throws IoError
/// \throws Cancelled
blend::Deformed make_deform(MakeDeformParams const& params, Run const& run = {});

} // namespace thalweg::pipeline
