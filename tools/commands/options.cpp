// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/recipe/presets.hpp>

namespace thalweg::tools {

std::map<std::string, std::string> fields_by_quantity(std::vector<std::string> const& fields) {
    std::map<std::string, std::string> named;
    for (std::string const& field : fields) {
        std::size_t const equals = field.find('=');
        refuse_if<BadParameter>(equals == std::string::npos || equals == 0 || equals + 1 == field.size(),
                                "commands.fields_by_quantity",
                                "--field {}: write QUANTITY=NAME, such as ds_arc=NEXT_DOWN", field);
        named[field.substr(0, equals)] = field.substr(equals + 1);
    }
    return named;
}

void add_network_options(CLI::App& app, std::string& path, io::ReadNetworkParams& read,
                         std::vector<std::string>& fields, char const* schema_flag) {
    app.add_option("NETWORK", path,
                   "A network: any vector file GDAL reads, a folder written by make, or a database (PG:dbname=rivers).")
        ->type_name("FILE(gpkg,shp,fgb,geojson)")
        ->required();
    app.add_option_function<std::string>(
           schema_flag, [&read](std::string const& name) { read.schema = io::schema_named(name); },
           "Set the schema of NETWORK. Default: recognised by its fields.")
        ->check(CLI::IsMember(schema_names()));
    add_list(app, "--field", "QUANTITY=NAME", fields,
             "Name the field of NETWORK that holds a quantity of the native schema, such as ds_arc=NEXT_DOWN. "
             "May be repeated.",
             '\0');
    app.add_option("--layer,--arcs-layer", read.arcs_layer,
                   "Read arcs from this layer, or from several, separated by commas.")
        ->type_name("NAME");
    app.add_option("--nodes-layer", read.nodes_layer, "Read nodes from this layer.")->type_name("NAME");
    app.add_option("--source-crs", read.source_crs,
                   "Read a NETWORK that has no CRS in this one. Default: its coordinates are metres.")
        ->type_name("EPSG:N");
}

std::vector<std::string> schema_names() {
    std::vector<std::string> names;
    for (io::SchemaTable const& table : io::all_schemas()) {
        names.emplace_back(table.name);
    }
    return names;
}

std::vector<std::string> preset_names() {
    std::vector<std::string> names;
    for (recipe::Preset const& preset : recipe::presets()) {
        names.push_back(preset.name);
    }
    return names;
}

void add_json_option(CLI::App& app, Session& session) {
    app.add_flag("--json", session.json, "Print one JSON object.");
}

void add_main_option(CLI::App& app, network::MainBy& main) {
    static std::map<std::string, network::MainBy> const names{{"file", network::MainBy::file},
                                                              {"name", network::MainBy::name},
                                                              {"area", network::MainBy::area},
                                                              {"length", network::MainBy::length},
                                                              {"arbolate", network::MainBy::arbolate}};
    app.add_option("--main", main,
                   "Tell main stems by the file (its level paths, names, classes and areas, as far as it has them), by "
                   "name, area, length of the flow path, or arbolate sum. Default: file.")
        ->type_name("file|name|area|length|arbolate")
        ->transform(CLI::CheckedTransformer(names, CLI::ignore_case));
}

void add_overwrite_option(CLI::App& app, io::Existing& existing, std::string const& meaning) {
    app.add_flag_callback(
        "--overwrite", [&existing] { existing = io::Existing::replace; }, meaning);
}

namespace {

/// The finite numbers between marks; empty: a part is none.
std::vector<double> numbers_in(std::string const& word, char mark) {
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= word.size();) {
        std::size_t const end = std::min(word.find(mark, begin), word.size());
        double number = 0.0;
        auto const [rest, fault] = std::from_chars(word.data() + begin, word.data() + end, number);
        if (fault != std::errc() || rest != word.data() + end || !std::isfinite(number)) {
            return {};
        }
        numbers.push_back(number);
        begin = end + 1;
    }
    return numbers;
}

bool is_side(double number) {
    constexpr double most = 65536.0;
    return number >= 1.0 && number <= most && number == std::floor(number);
}

} // namespace

void add_dem_options(CLI::App& app, io::ReadDemParams& reading) {
    app.add_option("--nodata", reading.nodata,
                   "Treat DEM cells with this stored value as no-data, beside what the file declares; nan: treat every "
                   "value as a height. Default: refuse values that look like undeclared no-data.")
        ->type_name("V");
    app.add_option("--band", reading.band,
                   "Read heights from this band or variable of the DEM, by number or name. Default: the only one, or "
                   "the one whose name means heights.")
        ->type_name("BAND")
        ->check([](std::string const& word) { return word.empty() ? "give a number or a name" : std::string(); });
    static std::map<std::string, io::HeightEncoding> const encodings{{"terrain-rgb", io::HeightEncoding::terrain_rgb},
                                                                     {"terrarium", io::HeightEncoding::terrarium}};
    app.add_option("--encoding", reading.encoding, "Decode the DEM's heights from the colours of a picture.")
        ->transform(CLI::CheckedTransformer(encodings, CLI::ignore_case));
    app.add_option_function<std::string>(
           "--raw-size",
           [&reading](std::string const& word) {
               auto const numbers = numbers_in(word, 'x');
               bool const is_size = !numbers.empty() && numbers.size() <= 2 && std::ranges::all_of(numbers, is_side);
               if (!is_size) {
                   throw CLI::ValidationError("--raw-size", fmt::format("'{}' is not N or WIDTHxHEIGHT", word));
               }
               reading.raw_width = static_cast<std::int64_t>(numbers.front());
               reading.raw_height = static_cast<std::int64_t>(numbers.back());
           },
           "Samples of a heightmap without a header (.r16, .r32, .raw): N a side, or WIDTHxHEIGHT. Default: as "
           "FILE.json "
           "says, else a square.")
        ->type_name("N|WxH");
    app.add_option("--raw-cell", reading.raw_cell_m,
                   "Distance [m] between samples of a heightmap. Default: as FILE.json says, else 1.")
        ->check(CLI::PositiveNumber);
    app.add_option_function<std::string>(
           "--raw-heights",
           [&reading](std::string const& word) {
               auto const numbers = numbers_in(word, ',');
               if (numbers.size() != 2 || !(numbers[0] < numbers[1])) {
                   throw CLI::ValidationError("--raw-heights",
                                              fmt::format("'{}' is not LOW,HIGH, such as 0,1500", word));
               }
               reading.raw_heights = std::pair{numbers[0], numbers[1]};
           },
           "Heights [m] of a heightmap's numbers 0 and 65535. Default: as FILE.json says, else numbers are metres.")
        ->type_name("LOW,HIGH");
}

std::string is_seed(std::string const& word) {
    std::int64_t seed = -1;
    auto const [end, fault] = std::from_chars(word.data(), word.data() + word.size(), seed);
    bool const is_one = fault == std::errc() && end == word.data() + word.size() && seed >= 0;
    return is_one ? "" : "'" + word + "' is not a seed: give a whole number from 0 to 9223372036854775807";
}

} // namespace thalweg::tools
