// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/measure/drainage/certificate.hpp>
#include <thalweg/network/order/main_stems.hpp>

namespace thalweg::commands {

/// Options of run_check().
struct CheckParams {
    std::string network = {};        ///< as for io::read_network
    io::ReadNetworkParams read = {}; ///< how its fields are read
    std::string dem = {};            ///< a DEM that the network should drain, and by which fix orients lines; "": none
    std::string fix = {};            ///< NAME.gpkg or NAME.shp: a repaired copy; "": none
    std::string findings = {};       ///< NAME.gpkg: the findings as points; "": none
    io::Existing existing = io::Existing::refuse; ///< fix and findings
    network::MainBy main = network::MainBy::file; ///< by what fix tells main stems
    double near_m = 0.0;                          ///< [m] >= 0: as measure::TopologyParams
    io::ReadDemParams reading = {};               ///< how the DEM is read
};

/// What run_check() returns.
struct CheckResult {
    std::int64_t arcs = 0;
    std::int64_t nodes = 0;
    std::string schema;            ///< naming scheme of the network's fields
    std::vector<Check> checks;     ///< of the topology, then of the DEM; one per kind, limit 0
    std::vector<Finding> findings; ///< of the topology, then of the DEM: everything that makes a check fail
    std::vector<Finding> notes;    ///< from reading: changes that were necessary for checking
    std::vector<Finding> mended;   ///< changes in the repaired copy, or why there is none; empty without fix
    std::vector<std::string> written;
    std::optional<measure::Certificate> certificate = {}; ///< with a DEM

    /// \return whether every check is ok
    bool ok() const;
};

/// Runs `thalweg check`: checks a network's files, optionally with a DEM; writes the findings, and a repaired copy in
/// the native schema if it passes the topology check itself. For a repaired copy, lines of an unknown schema are
/// accepted as they are. The input is never changed.
/// \return findings, and the files written
/// \throws BadInput when a file cannot be read as a network or DEM, or an output exists already
/// \throws BadParameter as the readers, and for an output that is the input or not .gpkg or .shp
CheckResult run_check(CheckParams const& params, Run const& run = {});

/// \internal
/// Formats the result as one JSON object: ok, arcs, nodes, schema, checks, findings, notes, mended, written;
/// certificate with a DEM.
/// \param checked the result of a check
/// \return JSON
std::string as_json(CheckResult const& checked);

} // namespace thalweg::commands
