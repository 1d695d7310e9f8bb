// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/network/order/main_stems.hpp>

namespace thalweg::commands {

/// Options of run_convert().
struct ConvertParams {
    std::string path = {};   ///< any input of io::read_network
    std::string output = {}; ///< a file or a database ("PG:...")
    io::Existing existing = io::Existing::refuse;
    io::ReadNetworkParams read = {};
    io::Schema schema = io::Schema::native;
    std::string format = {};       ///< a name of io::network_formats(); "": by the output's extension
    int max_upstream = 0;          ///< [2, ...] arcs that may end at one node; 0: any number
    double split_distance_m = 0.0; ///< [m] shift of confluences; 0: median segment length
    std::string dem = {};          ///< source of heights and areas if the file has none; frame of the mask
    double cell_m = 0.0;           ///< [m] cell size of the mask without a DEM
    network::MainBy main = network::MainBy::file; ///< by what main stems are told
    std::string table = "network";                ///< in a database, NAME or SCHEMA.NAME
    io::ReadDemParams reading = {};               ///< how the DEM is read
};

/// The result of a conversion.
struct ConvertResult {
    std::vector<std::string> written; ///< files, or relations of a database
    std::string schema;               ///< naming scheme of the source
    std::string crs;
    std::int64_t arcs = 0;
    std::int64_t nodes = 0;
    std::int64_t split = 0;        ///< number of moved confluences
    std::int64_t divergences = 0;  ///< minor branches, in a schema that holds them
    char const* heights = "file";  ///< file | dem | none
    char const* areas = "file";    ///< file | d8 | none; unknown ones of a file stay so
    std::vector<Finding> findings; ///< from reading
};

/// Runs `thalweg convert`: reads a network and writes it in any schema and format. Arcs are in the order of their ids,
/// renumbered from the schema's first id; orders and basins are computed. Attributes that the schema lacks are lost;
/// unknown values get the schema's mark for unknown; lines without heights are written without. The output is written
/// completely or not at all; the source is never replaced.
/// \return files and changes
/// \throws BadInput when the source is not a forest, the DEM does not cover it, the output exists and existing is
/// refuse, or the output is the source
ConvertResult run_convert(ConvertParams const& params, Run const& run = {});

} // namespace thalweg::commands
