// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/io/network/read_network.hpp>

namespace CLI {
class App;
}

namespace thalweg::tools {

/// Parses --field options.
/// \return names of columns, by quantity
/// \throws BadParameter when one is not QUANTITY=NAME
std::map<std::string, std::string> fields_by_quantity(std::vector<std::string> const& fields);

/// The options with which every command reads a network.
struct NetworkOptions {
    std::string path;
    std::string schema; ///< "": detected
    std::vector<std::string> fields;
    std::string layer;
    std::string nodes_layer;
    std::string source_crs; ///< of a file without a CRS

    /// \throws BadParameter when a field is not QUANTITY=NAME.
    io::ReadNetworkParams params() const;
};

/// Adds NETWORK, --from (or the names in schema_flag), --field, --layer, --nodes-layer and --source-crs.
void add_network_options(CLI::App& app, NetworkOptions& options, char const* schema_flag = "--from");

/// \return the names of all schemas.
std::vector<std::string> schema_names();

/// The option of commands that read a DEM.
void add_nodata_option(CLI::App& app, std::optional<double>& nodata);

/// Explains why a word is not a random seed that a recipe can hold; "": it is one.
std::string is_seed(std::string const& word);

} // namespace thalweg::tools
