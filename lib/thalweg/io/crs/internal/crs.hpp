// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

class OGRSpatialReference;

namespace thalweg::io {

// CRS as GDAL holds them.

/// Reads "EPSG:n" or WKT (never a URL or file) in traditional axis order: x or longitude first.
/// Throws BadInput when it is none.
OGRSpatialReference read_reference(std::string const& text);

/// Lambert's azimuthal equal-area projection (WGS 84) around a place.
OGRSpatialReference equal_area_around(double longitude_deg, double latitude_deg);

/// "EPSG:n" where it has a code, else WKT.
std::string name_of(OGRSpatialReference const& reference);

/// Whether it is projected with both axes in metres.
bool is_projected_in_metres(OGRSpatialReference const& reference);

// A CRS as formats other than GDAL's hold it.

/// The code of "EPSG:n", 0 for any other CRS.
int epsg_code(std::string const& crs);

/// A CRS in a message: WKT would fill the screen.
std::string in_message(std::string const& crs);

/// Text for a comment, which must end where its line does.
std::string one_line(std::string text);

} // namespace thalweg::io
