// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include <thalweg/core/network_file.hpp>
#include <thalweg/core/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::io {

/// A network with everything its tables hold.
struct NetworkTables {
    RaisedNetwork const& network;
    NetworkOrders const& orders;
    std::vector<double> const& us_area_m2; ///< by arc
    std::vector<double> const& ds_area_m2; ///< by arc
    std::vector<double> const& node_area_m2;
    std::string crs;
    std::map<std::string, std::string> run; ///< rows of the GeoPackage's run table
};

/// Writes PATH.gpkg: layers arcs (LineStringZ) and nodes (PointZ), table run. The same bytes for the same network.
void write_geopackage(NetworkTables const& tables, std::string const& path, Run const& run = {});

/// Writes the shapefiles PATH_arcs.* and PATH_nodes.* with the same fields (contract: names of at most 10 characters).
void write_shapefiles(NetworkTables const& tables, std::string const& path, Run const& run = {});

} // namespace thalweg::io
