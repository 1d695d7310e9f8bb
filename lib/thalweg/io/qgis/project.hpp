// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/io/qgis/styles.hpp>

namespace thalweg::io {

/// A layer of a project.
struct QgisLayer {
    enum class Kind : std::uint8_t { vector, raster, mesh };
    Kind kind = Kind::vector;
    std::string title = {}; ///< "Rivers"
    std::string file = {};  ///< relative to the project: "network.gpkg"
    std::string layer = {}; ///< of a GeoPackage: "arcs"
    QgisStyle style = {};
    bool is_shown = true;
    bool is_expanded = false; ///< its legend
    std::string legend = {};  ///< what is said above the colours of a raster or mesh; "": as QGIS does
};

/// What a project shows.
struct QgisProject {
    std::string title = {};
    std::vector<QgisLayer> layers = {}; ///< the topmost first
    Grid extent = {};                   ///< and CRS of all layers
    std::string background = "#ffffff";
};

/// Writes a project of QGIS, version 3.22 or later (.qgz), with relative paths.
/// \post the same bytes for the same project
/// \param project layers with their styles
/// \param path of the new file, in the folder of its layers
/// \throws BadInput when the CRS is not one
/// \throws IoError
void write_qgis_project(QgisProject const& project, std::string const& path);

} // namespace thalweg::io
