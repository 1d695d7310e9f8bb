// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

class OGRLayer;

/// Where the layers of a network are. Private to this module.
namespace thalweg::io {

/// The files of a network: a GeoPackage is both; nodes is "" where there is no file for them.
struct NetworkPlace {
    std::string arcs;
    std::string nodes;
};

/// Takes: see read_network. whole: a shapefile must be NAME_arcs.shp or NAME_nodes.shp. Throws: BadInput, IoError.
NetworkPlace find_network(std::string const& path, bool whole);

/// A file or database, opened to be read only.
class NetworkSource {
public:
    /// Throws: BadInput, IoError like read_network.
    NetworkSource(std::string const& path, Driver const& driver);

    /// "io.read_network: PATH", without a password.
    std::string const& what() const { return what_; }
    /// Null when it has none of this name.
    OGRLayer* layer(std::string const& name) const;
    std::vector<OGRLayer*> layers() const;

private:
    std::string what_;
    Dataset dataset_;
};

/// Whether a layer's features may be lines.
bool may_hold_lines(OGRLayer& layer);

} // namespace thalweg::io
