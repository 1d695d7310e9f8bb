// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Files ↔ values: rasters, networks, meshes and points; coordinate systems and units.
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/tar.hpp>
#include <thalweg/io/files/zip.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/packed.hpp>
#include <thalweg/io/mesh/lattice_files.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/io/qgis/project.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/raster/dem_derivatives.hpp>
#include <thalweg/io/raster/heightmap.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>
#include <thalweg/io/raster/web_tiles.hpp>
#include <thalweg/io/sources/sources.hpp>
#include <thalweg/io/tables/table.hpp>
