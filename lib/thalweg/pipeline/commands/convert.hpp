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

namespace thalweg::pipeline {

/// Options of convert().
struct ConvertParams {
    std::string path = {}; ///< whatever io::read_network reads
    io::ReadNetworkParams read = {};
    io::Schema schema = io::Schema::native;
    std::string format = {};           ///< a name of io::network_formats(); "" goes by the output's ending
    int max_upstream = 0;              ///< [2, ...] arcs that may end in one node; 0 for any number
    double split_distance_m = 0.0;     ///< [m] how far confluences are moved; 0: median length of the segments
    std::string dem = {};              ///< heights and areas where the file has none; frame of the mask
    double cell_m = 0.0;               ///< [m] cell of the mask without a DEM
    std::string table = "network";     ///< in a database, NAME or SCHEMA.NAME
    std::optional<double> nodata = {}; ///< of the DEM, as in io::ReadDemParams
};

/// What became of a network.
struct Converted {
    std::vector<std::string> written; ///< files, or relations of a database
    std::string schema;               ///< as the source was understood
    std::string crs;
    std::int64_t arcs = 0;
    std::int64_t nodes = 0;
    std::int64_t split = 0;        ///< confluences that were moved
    char const* heights = "file";  ///< file | dem | none
    char const* areas = "file";    ///< file | d8 | none
    std::vector<Finding> findings; ///< of reading
};

/// Reads a network and writes it in anyone's schema and format, into a file or a database ("PG:...").
/// \param output path of the output
/// \return arcs in the order of their ids, renumbered from the schema's first; orders and basins of the network as it
/// is; what the schema cannot hold is lost, unknown values are the schema's own mark for that. Unknown heights are 0.
/// Everything appears or nothing; the source is never replaced.
/// \throws BadInput when the source is not a set of trees, the DEM does not cover it, the output is taken and existing
/// is refuse, or it is the source
Converted convert(ConvertParams const& params, std::string const& output, io::Existing existing = io::Existing::refuse,
                  Run const& run = {});

} // namespace thalweg::pipeline
