// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/run.hpp>

namespace thalweg::io {

struct ReadRiversParams {
    std::string path;
    std::string layer;          ///< "" takes the only line layer
    std::string type_field = "rosgen"; ///< river type, optional in the file
    std::string rank_field;     ///< integer that falls downstream (NHDPlus: hydroseq); "" takes hydroseq where there is one
    std::string crs;            ///< of the result; "" takes the file's own when projected in metres, else its UTM zone
};

/// Reads the lines of any OGR source, multi-part lines part by part, reprojected and rounded to 1e-6 m.
/// Throws: BadInput naming file, layer and feature: missing file or layer, no line layer, no features, no CRS,
/// NaN coordinates, a line of fewer than two vertices; IoError.
RiverLines read_rivers(ReadRiversParams const& params, Run const& run = {});

} // namespace thalweg::io
