// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/network_file.hpp>
#include <thalweg/core/run.hpp>

namespace thalweg::io {

/// Reads layers arcs and nodes of a GeoPackage, or NAME_arcs.shp with its NAME_nodes.shp (given either, their folder,
/// or a folder that holds network.gpkg; arcs.shp and nodes.shp do too), as they stand: ids may repeat, lines may be
/// empty or wrong. Fields: node_id; arc_id, from_node, to_node, ds_arc, strahler, shreve, basin_id. Throws: BadInput:
/// no such file, no or several networks in a folder, a layer or field missing (names all), an id or order that is NULL
/// or not a whole number, a shape that is not one line or point with Z; IoError: the file is damaged.
NetworkFile read_network(std::string const& path, Run const& run = {});

} // namespace thalweg::io
