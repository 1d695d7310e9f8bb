// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run.hpp>

namespace thalweg::pipeline {

/// What `thalweg check` is asked to look at, and what to leave.
struct CheckJob {
    std::string network = {};  ///< as io::read_network takes it
    std::string dem = {};      ///< a DEM that the network shall drain; "" for none
    std::string fix = {};      ///< NAME.gpkg or NAME.shp: a mended copy; "" for none
    std::string findings = {}; ///< NAME.gpkg: the findings as points; "" for none
    double near_m = 0.0;       ///< [m] >= 0: ends closer than this should have met; 0 takes 1e-6 of the box's diagonal
    bool overwrite = false;    ///< replace fix and findings where they are there
};

struct CheckedFiles {
    std::int64_t arcs = 0;
    std::int64_t nodes = 0;
    std::vector<Check> checks;     ///< of the topology, then of the DEM; one a kind, limit 0
    std::vector<Finding> findings; ///< of reading, of the topology, of the DEM
    std::vector<Finding> mended;   ///< what the mended copy has changed; empty without fix

    bool ok() const; ///< every check is
};

/// Checks a network's files, and a DEM with them; mends a copy of the network. The input is never touched.
/// Throws: BadInput when a file cannot be read as a network or DEM, or an output is there already; BadParameter;
/// IoError; Cancelled.
CheckedFiles check_files(CheckJob const& job, Run const& run = {});

} // namespace thalweg::pipeline
