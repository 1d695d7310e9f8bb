// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/io/network/table.hpp>

/// Networks as graphs, for NetworkX and its like. Private to this module.
namespace thalweg::io {

/// A network as nodes and edges: an edge an arc, its attributes the arc's columns; a node's id is its number + 1.
struct GraphTables {
    Table arcs;
    Table nodes;
    StreamNetwork const& plan;
    std::string crs;
};

/// Writes a new GraphML file: a directed graph with attribute crs; nodes with their columns and x, y; edges with theirs
/// and their line, geometry, as well-known text. networkx.read_graphml(PATH, node_type=int) reads it.
/// Gives: numbers that read back bit for bit. Throws: BadInput naming table, row and column when a number is not
/// finite; IoError, also when the file exists; Cancelled. Source: GraphML 1.0.
void write_graphml(GraphTables const& graph, std::string const& path, Run const& run = {});

/// Writes the edges as a new CSV table: from_node, to_node, the other columns, geometry; a header first (RFC 4180).
/// pandas.read_csv and networkx.from_pandas_edgelist read it. Gives and throws: like write_graphml.
void write_edge_table(GraphTables const& graph, std::string const& path, Run const& run = {});

/// Writes NetworkX's own edge list: two nodes and a Python dictionary of the other columns a line, comments first.
/// networkx.read_edgelist(PATH, nodetype=int, create_using=networkx.DiGraph) reads it. Gives and throws: likewise.
void write_edge_list(GraphTables const& graph, std::string const& path, Run const& run = {});

} // namespace thalweg::io
