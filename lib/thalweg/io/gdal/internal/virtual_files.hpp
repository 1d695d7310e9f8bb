// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace thalweg::io {

/// Tells whether GDAL reads a file, or its mask or overviews beside it, as a virtual one, which names others, though it
/// is not called .vrt.
/// \param name GDAL's name of a file
/// \param path the user's
bool is_virtual_in_disguise(std::string const& name, std::string const& path);

/// Follows a virtual file to its sources.
/// \param name GDAL's name of a file; one that is not virtual passes
/// \param path the user's
/// \param is_disguised as is_virtual_in_disguise()
/// \throws BadInput when it, or a virtual file that it names, reads bytes of any file as heights (VRTRawRasterBand), or
/// names a file outside its folder and is disguised
void require_honest_sources(std::string const& name, std::string const& path, bool is_disguised);

} // namespace thalweg::io
