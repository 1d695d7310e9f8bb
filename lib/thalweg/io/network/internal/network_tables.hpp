// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/io/network/table.hpp>
#include <thalweg/io/network/write_network.hpp>

namespace thalweg::io {

// A user's columns beside those of a schema.

/// The names that columns get beside others that are taken, in a layer of a schema: u_NAME where the name is taken, or
/// is that of a feature's id or geometry, or the layer would be recognised as another schema's by it; else as they are;
/// with a number where two are one in any case of letters.
std::vector<std::string> user_names(AttributeTable const& attributes, std::vector<std::string> const& taken,
                                    Schema schema = Schema::native);

/// The same in a shapefile: of at most 10 bytes, cut before a letter and made unique by a number at their end.
std::vector<std::string> short_user_names(std::vector<std::string> const& names, std::vector<std::string> const& taken);

/// Adds the columns to a table. Takes: by row of the table the record of its values, 0 for none, where all are NULL.
/// The attributes must outlive the table.
void add_user_columns(Table& table, AttributeTable const& attributes,
                      std::function<std::int64_t(std::size_t row)> const& record, bool short_names,
                      Schema schema = Schema::native);

/// Length [m] of a line and the heights of its vertices.
double length_in_space(std::vector<Vec2> const& line, std::vector<double> const& z);

/// The layer arcs of the network schema. The arguments must outlive the table.
/// short_names: of user columns, for a shapefile.
Table arcs_table(NetworkTables const& tables, bool short_names = false);

/// The layer nodes of the network schema. The arguments must outlive the table.
Table nodes_table(NetworkTables const& tables);

/// The layer ridges of the network schema. The argument must outlive the table; every ridge has a vertex.
Table ridges_table(RidgeLines const& ridges, HeightUnit unit = HeightUnit::metre);

/// The layer secondary: lines that are not in the network, in plan. The arguments must outlive the table.
Table secondary_table(std::vector<SecondaryLine> const& secondary, UserData const* user);

/// The table sources. The argument must outlive the table.
Table sources_table(UserData const& user);

/// Throws BadInput when the tables are not those of the network: a wrong one would write another arc's numbers without
/// a sound. what: who asks ("io.write_geopackage: PATH"), begins the message.
void require_whole(NetworkTables const& tables, std::string const& what);

/// The layers of a network in a schema, that of the arcs first; of a foreign one there is no other.
/// Takes: short_names: at most ten characters. The arguments must outlive the tables.
/// Throws: BadInput like require_whole, and when more arcs meet than the schema can name.
std::vector<Table> network_layers(NetworkTables const& tables, Schema schema, bool short_names,
                                  std::string const& what);

} // namespace thalweg::io
