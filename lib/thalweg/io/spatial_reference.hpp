// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

class OGRSpatialReference;

namespace thalweg::io {

/// Sets GDAL's form of a CRS given as "EPSG:n" or WKT, x before y; "" clears it. Never opens a URL or file.
/// Throws: BadInput when it is none.
void set_reference(OGRSpatialReference& reference, std::string const& crs);

/// "EPSG:n" (AUTHORITY:code) where the reference has a code, else WKT; "" for none.
std::string text_of(OGRSpatialReference const* reference);

} // namespace thalweg::io
