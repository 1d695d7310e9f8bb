// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <thalweg/io/files/files.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/network/order/main_stems.hpp>

#include "commands/commands.hpp"

namespace thalweg::tools {

/// Parses --field options.
/// \return names of columns, by quantity
/// \throws BadParameter when one is not QUANTITY=NAME
std::map<std::string, std::string> fields_by_quantity(std::vector<std::string> const& fields);

/// \return the names of all presets of recipes.
std::vector<std::string> preset_names();

/// Adds NETWORK, --from (or the names in schema_flag), --field, --layer, --nodes-layer and --source-crs. What --field
/// names has yet to be parsed.
void add_network_options(CLI::App& app, std::string& path, io::ReadNetworkParams& read,
                         std::vector<std::string>& fields, char const* schema_flag = "--from");

/// \return the names of all schemas.
std::vector<std::string> schema_names();

/// An option that may be repeated, with values between separators; '\0': one value each time.
template <class T>
void add_list(CLI::App& app, char const* name, char const* type, std::vector<T>& values, char const* meaning,
              char separator = ',') {
    app.add_option(name, values, meaning)
        ->type_name(type)
        ->delimiter(separator)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

/// The names of a table of formats: "las, ply, xyz".
template <class Formats> std::string names_in_words(Formats const& formats) {
    std::string words;
    for (auto const& format : formats) {
        words += (words.empty() ? "" : ", ") + std::string(format.name);
    }
    return words;
}

/// The option of commands that print one JSON object.
void add_json_option(CLI::App& app, Session& session);

/// The option of commands that write.
void add_overwrite_option(CLI::App& app, io::Existing& existing,
                          std::string const& meaning = "Replace an existing file.");

/// The option of commands that read a DEM.
void add_dem_options(CLI::App& app, io::ReadDemParams& reading);

/// The option of commands that compute main stems.
void add_main_option(CLI::App& app, network::MainBy& main);

/// Explains why a word is not a random seed that a recipe can hold; "": it is one.
std::string is_seed(std::string const& word);

} // namespace thalweg::tools
