// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/network/schema.hpp>

namespace thalweg::io {

/// Options of read_network().
struct ReadNetworkParams {
    std::optional<Schema> schema = {};              ///< without it, it is recognised by the fields
    std::map<std::string, std::string> fields = {}; ///< a quantity (name_of), or node_id, to the field that holds it
    std::string arcs_layer = {};  ///< "" takes the layer arcs, else the only layer of lines that is understood, else
                                  ///< those that read_rivers() takes. Several are separated by commas
    std::string nodes_layer = {}; ///< "" takes the layer nodes of a network in the native schema, if it is there
    bool any_lines = false;       ///< lines of which neither schema nor fields are known are taken by their features
    bool bridge = false; ///< links without length, by which TauDEM joins three streams at one place, are left out: what
                         ///< flows into one flows into the next downstream. Not of the native schema
    std::string crs = {};        ///< to reproject it to, projected in metres; "" for its own, or its UTM zone
    std::string source_crs = {}; ///< CRS of a file that has none; "": its coordinates are treated as metres
};

/// Reads any network as it is: ids may repeat, links may lead nowhere, lines may be empty or wrong.
/// \param path anything OGR reads: a GeoPackage, FlatGeobuf, GeoJSON, a shapefile, a file geodatabase, a database
/// ("PG:dbname=..."), the folder of network.gpkg or of NAME_arcs.shp; with a NAME_arcs file its NAME_nodes (given
/// either). Fields are those of the schema in any case of letters, but for those that params.fields names; when these
/// tell arc_id and ds_arc, or arc_id, from_node and to_node, no schema is needed. Nor is one under any_lines: arcs have
/// the numbers of their features, from 1, and the links that docs/river_files.md lists, if any. A column that is the
/// feature id of its format is found like a field. The source is opened to be read only, and nothing is left beside it
/// \return arcs drawn downstream (where the lines of most linked arcs are drawn up, all are turned), in metres (what is
/// not in a projected CRS in metres, or in one whose lengths are off by more than 1 % and that is not the choice of
/// a network in the native schema, is reprojected to its UTM zone, to 1e-6 m), areas in m2; NetworkFile::says tells
/// which columns there were. Without a layer of nodes a node is made for each id of an end, at the place that most of
/// these ends have, or, where ends have no ids, for each place in plan. Without ds_arc it is the arc that begins where
/// an arc ends. What had to be bent or skipped is in NetworkFile::findings, each where its arc begins and by the number
/// that the file has; whatever is wrong is left for a check to find. Kinds of finding (feature; amount), the first
/// thousand of a kind and how many more there are: missing_field (none; fields), missing_nodes (none; 0), text_number
/// (none; 0), null_number and not_a_number (arc; 0), which stand as 0; not_a_line (none; shapes of a type skipped),
/// multi_part (arc; parts: when they join end to end they are one line, else each is an arc of the same id), curve
/// (arc; vertices of its line), measures (none; arcs whose M is left out), no_heights (none; arcs), no_crs (none; 0),
/// reprojected (none; 0), heights_converted (none; metres of a unit), turned (none; arcs), by_feature (none; arcs of a
/// file taken so under any_lines), as_text (none; columns of a type that is kept as texts), not_utf8 (none; texts of
/// which bytes are kept as \\xNN), cut_below (arc; the number of the arc downstream, which the file does not hold: an
/// outlet).
/// \throws BadInput no such file or layer, several layers, a schema that is not recognised (lists what was looked for),
/// no field of arc ids, a field without numbers, arcs and nodes in different CRS
/// \throws IoError the file is damaged, locked, or left in the middle of a change
NetworkFile read_network(std::string const& path, ReadNetworkParams const& params, Run const& run = {});

/// Reads a network in the native schema with all its layers and fields, lines with Z, numbers that are there and whole.
/// \param path path of the file
/// \return the network as in its file
/// \throws Error like the other, and BadInput instead of every finding
NetworkFile read_network(std::string const& path, Run const& run = {});

} // namespace thalweg::io
