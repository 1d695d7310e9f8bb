// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/output_file.hpp>
#include <thalweg/io/files/temporary_folder.hpp>
#include <thalweg/io/frame/ground_cell.hpp>
#include <thalweg/io/frame/places_on_earth.hpp>
#include <thalweg/io/frame/projection.hpp>
#include <thalweg/io/frame/same_frame.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/content_of.hpp>
#include <thalweg/io/gdal/conversions.hpp>
#include <thalweg/io/gdal/dataset_files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/has_layer.hpp>
#include <thalweg/io/gdal/packed.hpp>
#include <thalweg/io/gdal/plain_copy.hpp>
#include <thalweg/io/gdal/proj_guard.hpp>
#include <thalweg/io/mesh/read_points.hpp>
#include <thalweg/io/mesh/read_tin.hpp>
#include <thalweg/io/mesh/write_points.hpp>
#include <thalweg/io/mesh/write_tin.hpp>
#include <thalweg/io/network/find_rivers.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/io/network/table.hpp>
#include <thalweg/io/network/write_findings.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/io/network/write_postgis.hpp>
#include <thalweg/io/raster/contours.hpp>
#include <thalweg/io/raster/hillshade.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_dem.hpp>
#include <thalweg/io/raster/read_drawable.hpp>
#include <thalweg/io/raster/read_mask.hpp>
#include <thalweg/io/raster/read_polygons.hpp>
#include <thalweg/io/raster/warp_to_grid.hpp>
#include <thalweg/io/raster/write_catchments.hpp>
#include <thalweg/io/raster/write_dem.hpp>
