// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

struct NearestRiver {
    static constexpr std::uint32_t none = 0xffffffff;
    Cells<float> distance;       ///< [cells of the level] less the head start of the river cell
    Cells<std::uint32_t> number; ///< of the river cell in the level's rivers
};

/// The river cell nearest to each inner cell, by steps of 1 and sqrt(2) in two passes, where each river cell begins
/// with a head start (by number; empty: none). The frame has none. Memory: what the numbers are kept in.
NearestRiver nearest_river(LandLevel const& level, std::vector<float> const& head_start = {},
                           Cells<std::uint32_t> memory = {});

} // namespace thalweg::surface
