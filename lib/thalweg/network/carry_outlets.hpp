// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/grid.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

struct Carried {
    StreamNetwork network;
    std::vector<Finding> notes; ///< one an outlet that was carried, or that could not be
};

/// Carries every outlet that lies inside the grid to its border by the least-cost path of cells that meets no other
/// river: the last arc is drawn on (a new arc where several end in the outlet).
/// Takes: a network inside the grid. Gives: drawn vertices kept bit for bit; no crossing added.
Carried carry_outlets(StreamNetwork const& network, Grid const& grid);

} // namespace thalweg::network
