// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/measure/topology/topology.hpp>

/// The lines of mend_network, before adopt. Private to this module.
namespace thalweg::pipeline {

struct MendedLines {
    RiverLines rivers;                         ///< in the direction of flow, feature = arc_id
    std::vector<std::size_t> arcs;             ///< by river: number of its arc in the file
    std::vector<SecondaryLine> secondary = {}; ///< arcs that are no natural watercourse, feature = arc_id
    std::vector<Finding> mended;
};

/// Makes a line that can be adopted of every arc that can have one.
MendedLines mend_lines(NetworkFile const& file, measure::TopologyReport const& found, double near_m);

} // namespace thalweg::pipeline
