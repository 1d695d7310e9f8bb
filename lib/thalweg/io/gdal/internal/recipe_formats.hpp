// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

class GDALDataset;

/// The formats of files that a recipe may name. Private to this module.
namespace thalweg::io {

/// GDAL's names of formats that hold their data themselves, read by drivers that look no further than the files beside
/// the one they open; nullptr at the end.
std::vector<char const*> recipe_drivers();

/// Takes: GDAL's name of a file, and the user's. Throws: BadInput when the file is in another format.
void refuse_other_format(std::string const& name, std::string const& path);

/// Throws: BadInput when a GeoPackage holds a virtual table, which may read any file; the index of shapes is none.
void require_own_tables(GDALDataset& package, std::string const& path);

} // namespace thalweg::io
