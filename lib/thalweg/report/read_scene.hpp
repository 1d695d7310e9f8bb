// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>
#include <thalweg/report/pictures.hpp>

namespace thalweg::report {

struct ReadSceneParams {
    std::string source;                                          ///< a folder written by make, or a DEM
    std::string network;                                         ///< as DrawParams
    io::ReadDemParams reading = {};                              ///< as DrawParams
    std::int64_t most_side = io::ReadDrawableParams{}.most_side; ///< as io::ReadDrawableParams
};

struct SceneRead {
    Scene scene;
    std::vector<Finding> findings; ///< changes and choices
};

/// Reads everything that can be drawn. source: a folder written by make (dem.tif, network.gpkg, recipe.toml,
/// report.json, if present) or a raster of heights (io::read_drawable). network: "" or a file of river lines, clipped
/// to the DEM, imported and ordered, with the file's heights if these fall everywhere, else the DEM's. The title is
/// from the recipe or the raster's name.
/// \throws BadInput when the folder contains nothing to draw; as the readers and network::import_lines
SceneRead read_scene(ReadSceneParams const& params, Run const& run);

} // namespace thalweg::report
