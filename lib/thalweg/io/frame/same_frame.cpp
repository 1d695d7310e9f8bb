// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/frame/same_frame.hpp>

#include <cmath>

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/frame/internal/crs_text.hpp>
#include <thalweg/io/frame/internal/spatial_reference.hpp>

namespace thalweg::io {
bool same_crs(std::string const& a, std::string const& b, std::string const& of_a, std::string const& of_b) {
    if (a.empty() != b.empty()) {
        throw BadInput(fmt::format("{} has {}, {} has {}: assign the missing one (gdal_edit.py or ogr2ogr -a_srs "
                                   "EPSG:n)",
                                   of_a, in_message(a), of_b, in_message(b)));
    }
    if (a == b) {
        return true;
    }
    OGRSpatialReference first = read_reference(a);
    OGRSpatialReference second = read_reference(b);
    first.StripVertical();
    second.StripVertical();
    return first.IsSame(&second) != 0;
}

bool same_size(Grid const& a, Grid const& b) {
    return std::fabs(a.cell_m - b.cell_m) <= 1e-6 * b.cell_m;
}

bool same_cells(Grid const& a, Grid const& b) {
    double const most = 0.01 * a.cell_m;
    return a.width == b.width && a.height == b.height && std::fabs(a.west - b.west) <= most &&
           std::fabs(a.north - b.north) <= most && std::fabs(a.east() - b.east()) <= most &&
           std::fabs(a.south() - b.south()) <= most;
}

} // namespace thalweg::io
