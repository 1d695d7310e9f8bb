// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/network/growth/dla/grow_dla.hpp>

namespace thalweg::network {

enum class BranchChoice : std::uint8_t { largest, north, east, south, west, all };

/// Options of pick_branch().
struct BranchParams {
    BranchChoice choice = BranchChoice::largest; ///< which branch of the cluster; all: the whole cluster with its seed
    std::int64_t max_width = 0; ///< [cells] the branch ends at the first particle that makes its box wider; 0: no limit
    std::int64_t max_height = 0; ///< [cells] as max_width
    double turn_deg = 0.0;       ///< [-180, 180] the rotation that follows (rotate): the box is measured after it
};

/// What pick_branch() returns.
struct Branch {
    std::vector<Cell> cells; ///< lattice cells in order of arrival
    bool cut = false;        ///< a limit was reached before the last particle
};

/// Picks one branch of a cluster. `largest`: the descendants of that 4-neighbour of the seed with the most (ties: the
/// first to arrive), often nearly the whole cluster. A direction: the descendants of the particle with the most of them
/// in the quadrant around that direction, at least three in four of all its descendants (ties: the first to arrive).
/// \param cluster as grow_dla returns it
/// \param params options, each with its default, unit and range
/// \return a 4-connected set of cells
/// \throws BadInput when the branch is empty
/// \throws BadParameter when a parameter is outside its range
///
/// Source: \cite cao2009, section 3.2, where the left arm is chosen by eye.
Branch pick_branch(Cluster const& cluster, BranchParams const& params = {});

} // namespace thalweg::network
