// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/io/files/files.hpp>
#include <thalweg/make/make.hpp>

namespace thalweg::report {

/// Writes project.qgz, which shows the files that a folder has in QGIS, and the styles of its rasters and meshes
/// (dem.qml ...).
/// \param out holds every other layer already
/// \throws IoError
void write_qgis_files(make::MakeResult const& made, std::string const& title, io::OutputFolder const& out);

} // namespace thalweg::report
