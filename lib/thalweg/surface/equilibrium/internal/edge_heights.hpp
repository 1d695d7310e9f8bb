// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/surface/equilibrium/internal/land_level.hpp>
#include <thalweg/surface/equilibrium/internal/nearest_river.hpp>

/// Private to this module.
namespace thalweg::surface {

/// What lies beyond an open edge.
enum class Beyond : std::uint8_t {
    rivers, ///< at each place one as high as the nearest inside
    valleys ///< of basins with rivers of their own, which fall away from the heads inside
};

/// The cells at which an open land ends: the frame, once round, and land beside what is masked out.
struct EdgeCells {
    /// By cell: where it is, and the river nearest to it.
    struct Part {
        std::vector<std::uint32_t> cell;
        std::vector<std::uint32_t> river; ///< its cell; of the sea the sea's own
        std::vector<std::uint32_t> inner; ///< the cell itself, or the one beside it inside the frame
        std::vector<float> far;           ///< [finest cells] from the river; of the sea 0
    };
    Part ring; ///< clockwise from the north-west corner, the sea's cells among them
    Part inside;
    Beyond beyond = Beyond::rivers;
};
EdgeCells edge_cells(LandLevel const& level, NearestRiver const& near, Beyond beyond);

/// Sets their heights, along the frame as the mean over a stretch, and above the rivers that they touch. Rivers: as
/// high as the nearest. Valleys: lower by the fall of a river's first reaches, the farther the lower, but nowhere so
/// low that a large river could not flow from there to one of the grid.
void set_edge_heights(LandLevel& level, EdgeCells const& edge);

} // namespace thalweg::surface
