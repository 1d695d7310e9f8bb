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

/// What each --field names, by quantity. Throws: BadParameter when one is not QUANTITY=NAME.
std::map<std::string, std::string> fields_by_quantity(std::vector<std::string> const& fields);

/// Which network a command reads, and how it is understood: the same words for every command.
struct NetworkOptions {
    std::string path;
    std::string schema; ///< "" when it shall be recognised
    std::vector<std::string> fields;
    std::string layer;
    std::string nodes_layer;
    std::string source_crs; ///< of a file that has none

    /// Throws: BadParameter when a field is not given as QUANTITY=NAME.
    io::ReadNetworkParams params() const;
};

/// Adds NETWORK, --from (or the name or names of schema_flag), --field, --layer, --nodes-layer and --source-crs.
void add_network_options(CLI::App& app, NetworkOptions& options, char const* schema_flag = "--from");

/// The names of all schemas.
std::vector<std::string> schema_names();

/// The option of commands that read a DEM.
void add_nodata_option(CLI::App& app, std::optional<double>& nodata);

/// Why a word is not a random seed, which a recipe can hold too; "" where it is one.
std::string is_seed(std::string const& word);

} // namespace thalweg::tools
