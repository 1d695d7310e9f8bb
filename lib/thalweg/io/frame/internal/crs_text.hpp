// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

/// A CRS as formats other than GDAL's hold it. Private to this module.
namespace thalweg::io {

/// The code of "EPSG:n", 0 for any other CRS.
int epsg_code(std::string const& crs);

/// A CRS in a message: WKT would fill the screen.
std::string in_message(std::string const& crs);

/// Text for a comment, which must end where its line does.
std::string one_line(std::string text);

} // namespace thalweg::io
