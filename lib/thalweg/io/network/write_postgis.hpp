// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/io/network/write_network.hpp>

namespace thalweg::io {

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
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
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

} // namespace thalweg::io
