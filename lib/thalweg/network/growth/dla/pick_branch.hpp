// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/network/growth/dla/grow_dla.hpp>

namespace thalweg::network {

enum class BranchChoice : std::uint8_t { largest, north, east, south, west, all };

/// Options of pick_branch().
struct BranchParams {
    BranchChoice choice = BranchChoice::largest; ///< which arm of the cluster; all keeps the seed too
    std::int64_t max_width =
        0; ///< [cells] the branch is cut at the first particle that makes its box wider; 0 = no limit
    std::int64_t max_height = 0; ///< [cells] likewise
    double turn_deg = 0.0;       ///< [-180, 180] the branch will be turned by this (rotate): so is its box
};

/// What pick_branch() returns.
struct Branch {
    std::vector<Cell> cells; ///< lattice cells in order of arrival
    bool cut = false;        ///< the limits were reached before the last particle
};

/// Takes one arm of a cluster. largest: of what descends from each 4-neighbour of the seed, the largest (ties: the
/// first to arrive); often nearly all of the cluster, since its arms share a stem. A direction: the descendants of one
/// particle that have the most particles in the quadrant around it, three in four of them at least (ties: the first to
/// arrive).
/// \param cluster the cluster
/// \param params options, each with its default, unit and range
/// \return a 4-connected set of cells.
/// \throws BadInput when the arm is empty
/// \throws BadParameter
///
/// Source: \cite cao2009, section 3.2, where the left arm is chosen by eye.
Branch pick_branch(Cluster const& cluster, BranchParams const& params = {});

} // namespace thalweg::network
