// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/measure/drainage/certificate.hpp>

namespace thalweg::pipeline {

/// What `thalweg check` is asked to look at, and what to leave.
struct CheckJob {
    std::string network = {};          ///< as io::read_network takes it
    io::ReadNetworkParams read = {};   ///< how it is understood
    std::string dem = {};              ///< a DEM that the network drains, and by which fix orients lines; "" for none
    std::string fix = {};              ///< NAME.gpkg or NAME.shp: a mended copy; "" for none
    std::string findings = {};         ///< NAME.gpkg: the findings as points; "" for none
    double near_m = 0.0;               ///< [m] >= 0: as measure::TopologyParams
    bool overwrite = false;            ///< replace fix and findings where they are there
    std::optional<double> nodata = {}; ///< of the DEM, as in io::ReadDemParams
};

/// What check_files() returns.
struct CheckedFiles {
    std::int64_t arcs = 0;
    std::int64_t nodes = 0;
    std::string schema;            ///< how the network's fields were understood
    std::vector<Check> checks;     ///< of the topology, then of the DEM; one a kind, limit 0
    std::vector<Finding> findings; ///< of the topology, then of the DEM: whatever makes a check fail
    std::vector<Finding> notes;    ///< of reading: what had to be bent to be checked
    std::vector<Finding> mended;   ///< what the mended copy has changed, or why there is none; empty without fix
    std::vector<std::string> written;
    std::optional<measure::Certificate> certificate = {}; ///< with a DEM

    /// \return every check is
    bool ok() const;
};

/// Checks a network's files, and a DEM with them; writes the findings, and a mended copy in the native schema when it
/// passes the check of the topology itself. For a mended copy lines of no known schema are taken as they are. The input
/// is never touched.
/// \param job the files and options
/// \return findings, and the files written
/// \throws BadInput when a file cannot be read as a network or DEM, or an output is there already
/// \throws BadParameter also for an output that is the input or no .gpkg or .shp
CheckedFiles check_files(CheckJob const& job, Run const& run = {});

/// As one JSON object: ok, arcs, nodes, schema, checks, findings, notes, mended, written; certificate with a DEM.
/// \param checked the result of a check
/// \return the text
std::string as_json(CheckedFiles const& checked);

} // namespace thalweg::pipeline
