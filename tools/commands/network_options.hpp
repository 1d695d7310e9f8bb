// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/io/network/read_network.hpp>

namespace CLI {
class App;
}

namespace thalweg::tools {

/// Which network a command reads, and how it is understood: the same words for every command.
struct NetworkOptions {
    std::string path;
    std::string schema; ///< "" when it shall be recognised
    std::vector<std::string> fields;
    std::string layer;
    std::string nodes_layer;

    /// Throws: BadParameter when a field is not given as QUANTITY=NAME.
    io::ReadNetworkParams params() const;
};

/// Adds NETWORK, --from (or the name or names of schema_flag), --field, --layer and --nodes-layer.
void add_network_options(CLI::App& app, NetworkOptions& options, char const* schema_flag = "--from");

/// The names of all schemas.
std::vector<std::string> schema_names();

} // namespace thalweg::tools
