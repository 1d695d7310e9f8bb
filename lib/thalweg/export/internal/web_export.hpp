// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/raster/web_tiles.hpp>
#include <thalweg/report/pictures.hpp>

namespace thalweg::exports {

struct WebExportParams {
    double exaggeration = 1.0;            ///< > 0, of heights when the page opens
    io::WebPyramidParams pyramid = {};    ///< its limits
    std::int64_t most_bytes = 12'000'000; ///< [1, ...] of terrain.html: deeper levels of tiles are left out of it
};

struct WebExport {
    std::int64_t min_zoom = 0;
    std::int64_t max_zoom = 0;
    std::int64_t page_max_zoom = 0; ///< the deepest in terrain.html
    io::DegreeBox bounds;           ///< [degrees] around the DEM
    double min_m = 0.0;             ///< lowest height
    double max_m = 0.0;             ///< highest height
    std::int64_t tiles = 0;         ///< of heights and colours
    std::int64_t holes = 0;         ///< cells without data
    std::vector<std::string> files; ///< relative names, sorted
    std::vector<Finding> findings;  ///< changes and choices
};

/// Writes a scene for web maps: tiles of heights and colours (io::write_web_tiles), rivers.geojson (WGS 84; strahler,
/// and width [px] of the line), index.html, which shows them from any web server, and terrain.html, the same page with
/// tiles and rivers inside, for a double click. Cells without data take the level of the sea, else the height of the
/// nearest cell, where they are transparent. Without a CRS the DEM lies around 0, 0.
/// \param scene with a DEM; without a network there are no rivers
/// \param out an empty folder
/// \throws BadParameter for an exaggeration out of range
/// \throws BadInput when there is no DEM or no height; as io::web_pyramid and draw::ground
/// \throws IoError when a file cannot be written
WebExport write_web(report::Scene const& scene, WebExportParams const& params, io::OutputFolder const& out,
                    Run const& run);

} // namespace thalweg::exports
