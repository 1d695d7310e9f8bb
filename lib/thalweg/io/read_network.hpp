// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/network_file.hpp>
#include <thalweg/core/run.hpp>

namespace thalweg::io {

/// Reads layers arcs and nodes of a GeoPackage, or NAME_arcs.shp with its NAME_nodes.shp (given either, their folder, or
/// a folder that holds network.gpkg), as they stand. Throws: BadInput when a layer or field is missing; IoError.
NetworkFile read_network(std::string const& path, Run const& run = {});

} // namespace thalweg::io
