// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/gdal/access.hpp>

namespace thalweg::io {

/// Where the rivers of a path are.
struct RiverSource {
    std::string path;
    std::string layer; ///< "arcs" of a network that thalweg wrote, "lines" of OpenStreetMap, else ""
};

/// Looks for rivers.
/// \param path a file that OGR reads, a zip archive of one, a folder of shapefiles, the folder that `make` or `convert`
/// wrote (its network.gpkg, else its only NAME_arcs file or its only GeoPackage), or a database ("PG:...")
/// \return where the rivers are
/// \throws BadInput that says what is there instead: nothing, an empty file or folder, a raster, no layer with lines, a
/// file that GDAL cannot read
RiverSource find_rivers(std::string const& path);

/// Which lines of a file are rivers.
enum class LineFilter : std::uint8_t {
    natural, ///< no canal, ditch, pipe, weir, coastline ...: docs/river_files.md lists them
    none     ///< all of them
};

/// Options of read_rivers().
struct ReadRiversParams {
    Source path = {}; ///< anything OGR opens: GeoPackage, Shapefile, GeoJSON, FlatGeobuf, ...
    /// Several are separated by commas. "" takes the only line layer, or the one whose name says that it holds rivers;
    /// all folders of KML, tracks and routes of GPX, the ways of OpenStreetMap.
    std::string layer = {};
    std::string type_field = "rosgen"; ///< river type; optional in the file when it has this default name
    std::string rank_field = {};       ///< number that falls downstream; "" takes that of a known data set
    /// Of the result; "" takes the file's own when projected in metres whose lengths are off by 1 % at most, else
    /// its UTM zone.
    std::string crs = {};
    std::string lambda_field = "lambda";  ///< [1, 50] generator; optional in the file when it has this default name
    LineFilter filter = LineFilter::none; ///< what it takes away is in RiverLines::secondary
    std::string id_field = {};            ///< id of a line, and
    std::string down_field = {};          ///< that of the line downstream; "" takes the known ones. Both or none
    std::string from_field = {};          ///< node from which the water of a line comes, and
    std::string to_field = {};            ///< that to which it goes; "" takes the known ones. Both or none
    std::string direction_field = {};     ///< whether a line runs as it is drawn, in words of a known data set
    std::string height_field = {};        ///< height of all of a line, as of contours; "": heights of its vertices
    bool rings = false;                   ///< the rings of polygons are lines too, and polygons no lakes
    std::string where = {};               ///< condition on fields, as SQL's after WHERE: other features are not read
    /// CRS of a file that has none ("": such a file is refused); nothing where the user has no option to name it
    std::optional<std::string> source_crs = {};
    bool may_be_empty = false; ///< a layer without features gives no lines, instead of being refused
};

/// Reads the lines of any OGR source, multi-part lines part by part, curves as OGR linearises them, reprojected and
/// rounded to 1e-6 m. Heights are kept (in metres), measures ignored. Field names are found in any case of letters. The
/// feature of a line is its number in the layer's order, from 1. Fields of known data sets (all_data_sets), of
/// OpenStreetMap and of networks say which line is downstream, which channel is a minor one and how great a river is.
/// Features without a line of some length (null, empty, points that are all one) are left out, shapes that are not
/// lines are skipped: findings. Heights may come from fields of a line's ends. has_z: every vertex has a height, and
/// not all are the same (files that fill Z with 0 have none).
/// \return the lines
/// \throws BadParameter one of id_field and down_field without the other, or of from_field and to_field
/// \throws BadInput naming file, layer and feature: missing file, layer or named field, no or several line layers, no
/// features, no CRS, coordinates that are not finite or cannot be reprojected, nothing left, a lambda that is not a
/// whole number from 1 to 50
/// \throws IoError when the file cannot be read to its end
RiverLines read_rivers(ReadRiversParams const& params, Run const& run = {});

} // namespace thalweg::io
