// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/surface/equilibrium/internal/land_level.hpp>
#include <thalweg/surface/equilibrium/internal/nearest_river.hpp>

/// Private to this module.
namespace thalweg::surface {

/// The cells at which an open land ends: the frame, once round, and land beside what is masked out.
struct EdgeCells {
    std::vector<std::uint32_t> ring;       ///< clockwise from the north-west corner, the sea's cells among them
    std::vector<std::uint32_t> ring_river; ///< cell of the nearest river; of the sea its own
    std::vector<std::uint32_t> inner;
    std::vector<std::uint32_t> inner_river;
};
EdgeCells edge_cells(LandLevel const& level, NearestRiver const& near);

/// Sets their heights: as high as the nearest river, along the frame the mean over a stretch; above the rivers they
/// touch. So neighbouring basins stand as high as ours.
void set_edge_heights(LandLevel& level, EdgeCells const& edge);

} // namespace thalweg::surface
