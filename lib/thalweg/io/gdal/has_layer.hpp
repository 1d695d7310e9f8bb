// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace thalweg::io {

/// Whether a file that OGR reads has a layer of this name; false where there is no file. Throws: BadInput when GDAL
/// cannot read it.
bool has_layer(std::string const& path, std::string const& layer);

} // namespace thalweg::io
