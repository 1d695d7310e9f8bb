// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/stream_network.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/io/network/table.hpp>
#include <thalweg/io/network/write_network.hpp>

namespace thalweg::io {

/// The arcs of a network in the words, units and direction of a schema that is not the network's own; names of more
/// than ten characters are short where short_names is set. Private to this module.
/// Takes: a network with at most as many arcs upstream of one as the schema can name. What the fields tell stands with
/// Quantity in schema.hpp; what is not known is the field's own word for it, and -1 where it has none.
/// The arguments must outlive the table.
Table schema_arcs(SchemaTable const& schema, NetworkTables const& tables, bool short_names);

} // namespace thalweg::io
