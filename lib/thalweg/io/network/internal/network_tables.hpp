// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <thalweg/core/river_files.hpp>
#include <thalweg/io/files/internal/about.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/io/tables/table.hpp>

namespace thalweg::io {

// The columns of a user beside those of a schema.

/// Adds the columns to a table. The attributes must outlive the table.
/// \param record by row of the table: the record of its values; 0: none, all are NULL
void add_user_columns(Table& table, AttributeTable const& attributes,
                      std::function<std::int64_t(std::size_t row)> const& record, bool short_names,
                      Schema schema = Schema::native);

// The tables of a network, which must outlive them.

/// The layers of a network in a schema: arcs and nodes in the native one, else arcs alone.
/// \param short_names of at most ten characters
/// \param about whose errors they are
/// \throws BadInput when the tables do not belong to the network, or more arcs meet than the schema can name
std::vector<Table> network_layers(NetworkTables const& tables, Schema schema, bool short_names, About const& about);

/// The layer nodes of the native schema.
Table nodes_table(NetworkTables const& tables);

/// All tables of the native schema's GeoPackage.
/// \throws BadInput like network_layers, or when a ridge has fewer than two vertices
std::vector<Table> geopackage_tables(NetworkTables const& tables, About const& about);

} // namespace thalweg::io
