// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace thalweg::io {

/// \param path path of the file
/// \param layer name of the layer
/// \return whether a file that OGR reads has a layer of this name; false where there is no file.
/// \throws BadInput when GDAL cannot read it
bool has_layer(std::string const& path, std::string const& layer);

} // namespace thalweg::io
