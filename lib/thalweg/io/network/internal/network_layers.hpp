// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/io/network/table.hpp>
#include <thalweg/io/network/write_network.hpp>

namespace thalweg::io {

/// Throws BadInput when the tables are not those of the network: a wrong one would write another arc's numbers without
/// a sound. what: who asks ("io.write_geopackage: PATH"), begins the message.
void require_whole(NetworkTables const& tables, std::string const& what);

/// The layers of a network in a schema, that of the arcs first; of a foreign one there is no other. Private to this
/// module. Takes: short_names: at most ten characters. The arguments must outlive the tables.
/// Throws: BadInput like require_whole, and when more arcs meet than the schema can name.
std::vector<Table> network_layers(NetworkTables const& tables, Schema schema, bool short_names,
                                  std::string const& what);

} // namespace thalweg::io
