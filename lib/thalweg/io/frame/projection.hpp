// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

namespace thalweg::io {

/// Reads a user's CRS: "EPSG:32633" or WKT; never a URL or file.
/// \param text the text
/// \return "EPSG:n" where it has a code, else WKT; of a CRS with heights its horizontal part.
/// \throws BadInput when it is none, is geographic, or is not in metres
std::string projected_crs(std::string const& text);

/// \pre latitude within [-80, 84]; zones are 6 degrees wide everywhere.
/// \param longitude_deg [degrees] longitude
/// \param latitude_deg [degrees] latitude
/// \return the UTM zone (WGS 84) of a geographic position, as "EPSG:326zz" or "EPSG:327zz".
/// \throws BadInput elsewhere
std::string utm_zone(double longitude_deg, double latitude_deg);

/// \param crs "EPSG:n" or WKT; "": none
/// \return the number of a UTM zone (WGS 84), 1 to 60, of "EPSG:326zz" or "EPSG:327zz"; nothing of another CRS.
std::optional<int> utm_number(std::string const& crs);

/// A box of longitudes and latitudes [degrees], west <= east, south <= north.
struct DegreeBox {
    double west = 0.0;
    double south = 0.0;
    double east = 0.0;
    double north = 0.0;
};

/// \param crs "EPSG:n" or WKT; "": none
/// \param box [degrees] longitudes and latitudes
/// \return by how much a UTM zone lengthens a line at most, anywhere in a box: 0.01 is 1 %; another CRS by 0.
///
/// Source: \cite snyder1987, Map Projections, eq. 8-4 (of the sphere).
double utm_stretch(std::string const& crs, DegreeBox const& box);

} // namespace thalweg::io
