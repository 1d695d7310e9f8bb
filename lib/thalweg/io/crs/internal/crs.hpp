// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/vec.hpp>
#include <thalweg/io/files/internal/about.hpp>

class OGRSpatialReference;

namespace thalweg::io {

// CRS as GDAL objects.

/// Reads "EPSG:n" or WKT (never a URL or file) in traditional axis order: x or longitude first.
/// \throws BadInput when it is not a CRS
OGRSpatialReference read_reference(std::string const& text);

/// Lambert's azimuthal equal-area projection centred on a position.
/// \param globe its longitudes and latitudes; null: WGS 84
OGRSpatialReference equal_area_around(double longitude_deg, double latitude_deg,
                                      OGRSpatialReference const* globe = nullptr);

/// The projection in metres for what has none, of every command: the UTM zone of the middle; where that does not serve
/// (more than 12 degrees wide, beyond latitudes -80 and 84, another body than the Earth) Lambert's azimuthal equal-area
/// projection around the middle, in whole degrees.
/// \param own any CRS of the body
/// \param middle_deg longitude and latitude
/// \param wide_deg extent in longitude
/// \return as name_of
std::string metric_crs_around(OGRSpatialReference const& own, Vec2 middle_deg, double wide_deg);

/// \throws BadInput where data cover more than 180 degrees of longitude, which no projection in metres serves
void require_half_a_globe(double west_deg, double east_deg, About const& about);

/// Whether a CRS is one of the Earth, by the size of its ellipsoid.
bool is_on_earth(OGRSpatialReference const& reference);

/// same_crs, for a function whose errors these are.
bool is_same_crs(std::string const& a, std::string const& b, About const& of_a, std::string const& of_b);

/// "EPSG:n" if it has a code, else WKT.
std::string name_of(OGRSpatialReference const& reference);

/// Whether it is projected with both axes in metres.
bool is_projected_in_metres(OGRSpatialReference const& reference);

// A CRS for formats other than GDAL's.

/// The code of "EPSG:n"; 0: any other CRS.
int epsg_code(std::string const& crs);

/// A CRS in a message, abbreviated: WKT would fill the screen.
std::string in_message(std::string const& crs);

/// Text for a comment, which ends with its line.
std::string one_line(std::string text);

} // namespace thalweg::io
