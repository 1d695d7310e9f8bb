// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/report/pictures.hpp>

namespace thalweg::pipeline {

struct SceneRead {
    Scene scene;
    std::vector<std::string> notes; ///< what was changed or chosen for the pictures, in words
};

/// A folder that make left, or a raster of heights.
struct SceneSource {
    std::string path;
    std::optional<double> nodata = {}; ///< as in io::ReadDrawableParams
};

/// Reads what can be drawn. source: a folder that make left (dem.tif, network.gpkg, recipe.toml, report.json, as far as
/// they are there) or a raster of heights (io::read_drawable). network: "" or a file of river lines, cut at the edge of
/// the DEM, adopted and ordered; their heights are the file's where these fall all the way, else those of the DEM.
/// Gives: the title from the recipe or the raster's name.
/// Throws: BadInput: nothing to draw in the folder; what the readers and network::adopt throw; Cancelled.
SceneRead read_scene(SceneSource const& source, std::string const& network = {}, Run const& run = {});

} // namespace thalweg::pipeline
