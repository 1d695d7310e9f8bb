// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace thalweg::io {

/// Reads a user's CRS: "EPSG:32633" or WKT; never a URL or file.
/// Gives: "EPSG:n" where it has a code, else WKT; of a CRS with heights its horizontal part.
/// Throws BadInput when it is none, is geographic, or is not in metres.
std::string projected_crs(std::string const& text);

/// The UTM zone (WGS 84) of a geographic position, as "EPSG:326zz" or "EPSG:327zz".
/// Takes: latitude within [-80, 84]; zones are 6 degrees wide everywhere. Throws BadInput elsewhere.
std::string utm_zone(double longitude_deg, double latitude_deg);

} // namespace thalweg::io
