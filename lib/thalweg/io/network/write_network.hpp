// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/io/network/schema.hpp>

namespace thalweg::io {

/// What a user's file said of its lines, for the arcs and secondary lines that they became.
struct UserData {
    AttributeTable attributes;
    std::vector<std::int64_t> record = {};          ///< by arc, from 1; 0 for none
    std::vector<std::vector<Stretch>> sources = {}; ///< by arc; may be empty
};

/// A network with everything its tables hold.
struct NetworkTables {
    ElevatedNetwork const& network;
    NetworkOrders const& orders;
    std::vector<double> const& us_area_m2;   ///< by arc; -1 where it is not known
    std::vector<double> const& ds_area_m2;   ///< by arc; likewise
    std::vector<double> const& node_area_m2; ///< by node; likewise
    std::string crs;
    std::map<std::string, std::string> run;                ///< rows of the GeoPackage's run table
    std::vector<std::uint8_t> const* braided = nullptr;    ///< by arc, 1 or 0; without it all are 0
    RidgeLines const* ridges = nullptr;                    ///< layer ridges of the GeoPackage; none when null or empty
    std::vector<SecondaryLine> const* secondary = nullptr; ///< layer secondary of the GeoPackage; likewise
    UserData const* user = nullptr;                        ///< none when null
    HeightUnit unit = HeightUnit::metre; ///< of heights in the native schema; feet add the column z_unit
    bool heights = true;                 ///< else unknown: shapes are in plan, columns NULL or the schema's word
    std::vector<NodeId> sinks = {};      ///< outlets where water ends inland, ascending: nodes of the kind sink
    /// By arc: of its own catchment, where the areas at its ends are not known; NaN: unknown. None when null.
    std::vector<double> const* own_area_m2 = nullptr;
};

/// Writes PATH (.gpkg is added where it is missing): layers arcs (LineStringZ) and nodes (PointZ), table run, with the
/// fields of the network schema and five more by arc: survives (real [cells]; -1 for infinity), feature (integer), type
/// (text; none where there is none), braided (integer, 1 or 0) and given (integer, 0 for a side valley grown in the
/// terrain, else 1). dist_out of an arc counts from its downstream end, as in NHDPlus (Pathlength) and HydroRIVERS
/// (DIST_DN_KM). arc_id is the arc's number + 1, node_id the node's + 1. Where there are ridges, also the layer ridges
/// (LineStringZ): ridge_id, the ridge's number + 1; left and right, the labels of its streams; length [m] in plan;
/// z_min and z_max [m]. Where there are lines that are not in the network, also the layer secondary (LineString):
/// feature, reason (text) and length [m]. Shapefiles have neither. With user data: its columns in arcs and secondary,
/// those with a name of ours as u_NAME, and the table sources: arc_id, feature, from_m and to_m [m] along the arc from
/// its upstream end.
/// \post the same bytes for the same network, on any day.
/// \param tables the values of the tables
/// \param path path of the file
/// \throws BadInput naming the arc or node when the values do not belong to the network, an arc's end is not its node,
/// a node reaches no outlet, a ridge has fewer than two vertices, a number is not finite or, in a shapefile, has more
/// digits than its field
/// \throws IoError also when the file exists
void write_geopackage(NetworkTables const& tables, std::string const& path, Run const& run = {});

/// Writes the shapefiles PATH_arcs.* and PATH_nodes.* with the same fields, UTF-8: reals of 24 characters (9 decimals
/// for lengths, 6 for areas, 15 for slopes); user columns as shortened_names has them.
/// \post like write_geopackage.
/// \param tables the values of the tables
/// \param path path of the file
/// \throws Error like write_geopackage
void write_shapefiles(NetworkTables const& tables, std::string const& path, Run const& run = {});

/// A column of a user, and its name in shapefiles, where that differs from the one in other formats: names have at most
/// 10 bytes there.
struct ShortenedName {
    std::string name;
    std::string in_shapefile;
};
/// \internal
std::vector<ShortenedName> shortened_names(NetworkTables const& tables, Schema schema = Schema::native);

/// How a network is written.
enum class NetworkFormat : std::uint8_t {
    geopackage,
    shapefile,
    flatgeobuf,
    geojson,     ///< in degrees, as RFC 7946 has it
    geojson2008, ///< in the network's CRS, which a member crs names; many readers take its metres for degrees
    graphml,     ///< a graph of nodes and edges, lines as well-known text
    csv,         ///< edges, a header line first
    edges,       ///< the edge list of NetworkX: two nodes and a dictionary a line
    mask         ///< a raster of bytes, 1 in the cells that rivers run through
};

/// A network format name.
struct NetworkFormatName {
    NetworkFormat format;
    char const* name;   ///< "gpkg"
    char const* ending; ///< ".gpkg"
};
std::vector<NetworkFormatName> const& network_formats();

/// \param name its name
/// \param path path of the file
/// \return the format of a name, or where it is "" of a path's ending, in any case of letters.
/// \throws BadParameter that lists the names there are
NetworkFormat network_format(std::string const& name, std::string const& path);

/// Options of network_files().
struct WriteNetworkParams {
    NetworkFormat format = NetworkFormat::geopackage;
    Schema schema = Schema::native;
    Grid grid = {}; ///< of the mask
};

/// \param path path of the file
/// \return the files that a network written to a path has, PATH's folder left out: PATH itself, or in the network
/// schema NAME_arcs and NAME_nodes of shapefile, FlatGeobuf and GeoJSON; of a shapefile all it may have, .shp first.
std::vector<std::string> network_files(std::string const& path, WriteNetworkParams const& params);

/// Writes a network in any format and schema: in the native schema both layers like write_geopackage, in another its
/// layer of arcs alone (also nodes where it is a graph).
/// \post the same bytes for the same network, on any day. Lines are bit for bit those of the network, but for GeoJSON
/// in degrees (within 0.1 mm); numbers in text
/// (GraphML, CSV, edge lists) are the shortest that read back the same. Quantities that are not known are what the
/// schema has for them (schema.hpp).
/// \param tables the values of the tables
/// \param path path of the file
/// \throws Error as write_geopackage
/// \throws BadInput naming the place, also when more arcs meet than the schema can name, or GeoJSON has no CRS or
/// cannot name it
void write_network(NetworkTables const& tables, std::string const& path, WriteNetworkParams const& params = {},
                   Run const& run = {});

/// Options of write_postgis().
struct WritePostgisParams {
    Schema schema = Schema::native;
    std::string name = "network"; ///< of what is made, "NAME" or "SCHEMA.NAME": small letters, digits and _
    bool overwrite = false;       ///< replaces tables and view of these names
};

/// \param name its name
/// \return whether a name is that of a PostgreSQL database ("PG:dbname=rivers host=...").
bool is_postgis(std::string const& name);

/// Writes a network into a PostGIS database, in one transaction: wholly or not at all.
/// \param tables the values of the tables
/// \param connection the database, "PG:..."
/// \return the names of what it made: in the network schema tables NAME_arcs and NAME_nodes, in another one table NAME;
/// where the schema names nodes also the view NAME_edges (id, source, target, cost, reverse_cost, geom) as pgRouting
/// takes it: cost is the arc's length in the schema's unit, and -1 upstream. Columns have the schema's names in small
/// letters, and fid is their primary key. Lines are bit for bit those of the network, other numbers have the 15 digits
/// in which GDAL hands them over.
/// \throws BadParameter when the name is none
/// \throws BadInput when what it would make is there already and overwrite is not set, or there is no such schema in
/// the database
/// \throws IoError also when no database answers or a view of somebody's needs what would be replaced; otherwise as
/// write_network
std::vector<std::string> write_postgis(NetworkTables const& tables, std::string const& connection,
                                       WritePostgisParams const& params = {}, Run const& run = {});

/// Writes findings as the points of a new GeoPackage: layer findings, with fields kind (text), feature (integer; 0 for
/// none), amount (real, in the unit of its kind) and text.
/// \post one point a finding, in their order; a layer without features where there is none; the same bytes on any day.
/// \pre findings; what is not finite in them stands as 0.
/// \param findings the findings
/// \param crs of their places, "" for none
/// \param path path of the file
/// \throws IoError also when the file exists
void write_findings(std::vector<Finding> const& findings, std::string const& crs, std::string const& path,
                    Run const& run = {});

} // namespace thalweg::io
