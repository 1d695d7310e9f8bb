// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include <thalweg/core/network_file.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/network/internal/read_network_layers.hpp>
#include <thalweg/io/network/internal/read_network_notes.hpp>

/// The features of a network's layers. Private to this module.
namespace thalweg::io {

/// Reads the arcs as they are drawn and linked in the file, and what the file says. Throws: like read_network.
void read_arcs(NetworkFile& file, Layer const& arcs, std::optional<Schema> schema, Wish const& wish,
               Driver const& driver, Notes& notes, Run const& run);

/// Reads which features arcs were made of. What is no such table is passed over.
void read_sources(NetworkFile& file, Layer const& sources, Driver const& driver, Run const& run);

/// Reads the nodes. Takes: the field of their ids. Throws: like read_network.
void read_nodes(NetworkFile& file, Layer const& nodes, std::string const& node_id, Driver const& driver, Notes& notes,
                Run const& run);

} // namespace thalweg::io
