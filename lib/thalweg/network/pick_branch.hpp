// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/network/grow_dla.hpp>

namespace thalweg::network {

enum class BranchChoice : std::uint8_t { largest, north, east, south, west, all };

struct BranchParams {
    BranchChoice choice = BranchChoice::largest; ///< which arm of the cluster; all keeps the seed too
    std::int64_t max_width =
        0; ///< [cells] the branch is cut at the first particle that makes its box wider; 0 = no limit
    std::int64_t max_height = 0; ///< [cells] likewise
};

struct Branch {
    std::vector<Cell> cells; ///< lattice cells in order of arrival
    bool cut = false;        ///< the limits were reached before the last particle
};

/// Takes one arm of a cluster: what descends from one 4-neighbour of the seed (its largest, or that of a direction).
/// Gives: a 4-connected set of cells. Throws: BadInput when the arm is empty.
/// Source: paper 000, section 3.2.
Branch pick_branch(Cluster const& cluster, BranchParams const& params = {});

} // namespace thalweg::network
